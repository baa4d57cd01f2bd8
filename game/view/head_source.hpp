// Where the head of the viewer in front of projection walls is: from the tracker that the display file names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "content/displays/display_file.hpp"
#include "engine/tracking/dtrack_receiver.hpp"
#include "engine/tracking/head_filter.hpp"
#include "engine/tracking/head_pose.hpp"

namespace bolt::view {

// The conversion from the tracker's frame to the room.
tracking::TrackerRegistration registration_of(const content::HeadTracking& head);

class HeadSource {
  public:
    // Opens the tracker; `folder`: of the display file, to which its recording is relative. Fails if the port
    // is taken, the recording cannot be read, or the tracker is "openxr", which is not supported.
    static Result<HeadSource> open(const content::HeadTracking& head, const std::filesystem::path& folder);

    // The head at this time, s, which never decreases from call to call. A recording begins at the first
    // call. Without a tracker the head is always tracked: at the fixed pose.
    tracking::FilteredHead at(double seconds);

    // A line about the tracker if its state has changed since the last call, such as "the tracker has lost
    // the head"; else empty.
    std::string take_change();

  private:
    struct Recording {
        std::vector<tracking::HeadSample> poses;
        std::optional<double> begin;  // s, on the clock of at()
        double played = 0.0;          // s, of the recording
    };
    struct Fixed {};
    HeadSource() = default;
    std::vector<tracking::HeadSample> samples_until(double seconds);

    std::variant<Fixed, tracking::DtrackReceiver, Recording> source_;
    tracking::TrackerRegistration registration_;
    tracking::HeadFilterSettings settings_;
    tracking::HeadFilterState filter_;
    int body_ = 0;
    std::optional<tracking::HeadStatus> told_;  // the state that take_change() has told
};

}  // namespace bolt::view
