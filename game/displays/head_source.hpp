// The viewer's head in front of projection walls, from the tracker that the display file names.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "content/displays/display_file.hpp"
#include "engine/tracking/dtrack_receiver.hpp"
#include "engine/tracking/head_filter.hpp"
#include "engine/tracking/head_pose.hpp"

namespace bolt::displays {

// The samples that have arrived from the tracker.
struct TrackerCounts {
    tracking::DtrackCounts dtrack;  // with tracker dtrack only
    std::uint64_t samples = 0;      // poses of the tracked body
    std::vector<int> bodies;        // DTrack's numbers of all bodies that were seen, ascending
};

class HeadSource {
  public:
    // `folder`: that of the display file. Fails if the UDP port is in use, or the recording is wrong.
    static Result<HeadSource> open(const content::HeadTracking& head, const std::filesystem::path& folder);

    // Updates the head and returns it at the time `now`, s on a steady clock, which must not decrease from
    // call to call. Reads the samples that have arrived; never waits. Recorded poses are played once, from
    // the first call on.
    tracking::FilteredHead at(double now);

    // For trackers that the caller reads. at() uses the sample.
    void add_sample(const tracking::BodySample& body);

    [[nodiscard]] const TrackerCounts& counts() const { return counts_; }
    [[nodiscard]] int port() const { return receiver_ ? receiver_->port() : 0; }

  private:
    HeadSource() = default;
    void receive(double now);
    void play(double now);

    tracking::TrackerRegistration registration_;
    tracking::HeadFilterSettings settings_;
    tracking::HeadFilterState state_;
    std::optional<tracking::DtrackReceiver> receiver_;
    int body_ = 0;
    std::vector<tracking::BodySample> recording_;
    std::optional<double> started_;              // when the recording began, less the time of its first pose
    double played_until_ = 0.0;                  // s, in the recording
    std::vector<tracking::HeadSample> waiting_;  // in the room, since the last call of at()
    TrackerCounts counts_;
};

}  // namespace bolt::displays
