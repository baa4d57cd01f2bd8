// The viewer's head in front of projection walls, from the tracker that the display file names.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "content/displays/display_file.hpp"
#include "engine/tracking/dtrack_receiver.hpp"
#include "engine/tracking/head_filter.hpp"
#include "engine/tracking/head_pose.hpp"
#include "engine/xr/pose_tracker.hpp"

namespace bolt::head_tracking {

// The samples that have arrived from the tracker.
struct TrackerCounts {
    tracking::DtrackCounts dtrack;  // with tracker dtrack only
    std::uint64_t samples = 0;      // poses of the tracked body
    std::vector<int> bodies;        // DTrack's numbers of all bodies that were seen, ascending
};

// A flystick in the viewer's hand.
struct Wand {
    std::optional<Pose> aim;  // in the room, points along −z; none: the tracker does not see it
    // Buttons: `select` presses on the panel, `menu` pauses, `tool` takes the wrench or lays it down.
    bool select = false, menu = false, tool = false;
    double stick_x = 0.0, stick_y = 0.0;  // −1 … 1; y away from the user
};

class HeadSource {
  public:
    // `folder`: that of the display file. Fails if the UDP port is in use, the recording is wrong, or there
    // is no OpenXR runtime that tracks. A runtime that ends later is searched for once a second.
    static Result<HeadSource> open(const content::HeadTracking& head, const std::filesystem::path& folder);

    // Updates the head and returns it at the time `now`, s on a steady clock, which must not decrease from
    // call to call. Reads the samples that have arrived; never waits. Recorded poses are played once, from
    // the first call on.
    tracking::FilteredHead at(double now);

    // Adds a sample of a tracker that the caller reads; the next at() uses it.
    void add_sample(const tracking::BodySample& body);

    // The wand at the last at(); none: there is none, or it has sent nothing for max_sample_age.
    [[nodiscard]] const std::optional<Wand>& wand() const { return wand_; }

    [[nodiscard]] const TrackerCounts& counts() const { return counts_; }
    // The UDP port on which DTrack's packets arrive; 0 with another tracker.
    [[nodiscard]] int port() const { return receiver_ ? receiver_->port() : 0; }

  private:
    HeadSource() = default;
    void receive(double now);
    void read_wand(const tracking::DtrackFrame& frame, double now);
    void play(double now);
    void track(double now);

    tracking::TrackerRegistration registration_;
    tracking::HeadFilterSettings settings_;
    tracking::HeadFilterState state_;
    std::optional<tracking::DtrackReceiver> receiver_;
    int body_ = 0;
    std::optional<content::Flystick> flystick_;
    std::optional<Wand> wand_;
    double wand_time_ = 0.0;                    // s, of the last packet with the flystick
    std::optional<xr::TrackedDevice> tracked_;  // with tracker openxr only
    std::unique_ptr<xr::PoseTracker> openxr_;   // null: the runtime has ended
    double next_search_ = 0.0;                  // s
    std::vector<tracking::BodySample> recording_;
    std::optional<double> started_;              // s, time of at() minus time in the recording
    double played_until_ = 0.0;                  // s, in the recording
    std::vector<tracking::HeadSample> waiting_;  // in the room, since the last call of at()
    TrackerCounts counts_;
};

}  // namespace bolt::head_tracking
