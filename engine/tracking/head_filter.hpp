// Makes a steady pose of the head from the samples of a tracker: it bridges dropouts and rejects jumps.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/base/math.hpp"

namespace bolt::tracking {

// Pose of the head in the room at a time, s, on any steady clock. head_pose.hpp makes it from a BodySample.
struct HeadSample {
    double time = 0.0;
    Pose pose;
};

struct HeadFilterSettings {
    Pose fixed_head;            // without a tracker, and after a dropout
    double dropout_time = 0.5;  // s for which the pose is held after the last sample
    double fade_time = 2.0;     // s, from the held pose to the fixed head
    double max_speed = 4.0;     // m/s; a faster change is a jump
    double max_turn = 20.0;     // rad/s, likewise; people turn their heads at up to 12 rad/s
    // s. After a jump, poses are accepted when they have agreed for this long, or as soon as a head at
    // max_speed and max_turn could have reached them.
    double jump_time = 0.3;
    double return_time = 0.3;  // s, from the shown pose to the tracked pose after a dropout or a jump
};

// A change of the pose within these limits never counts as a jump: it may be noise between samples that
// arrive at nearly the same time.
inline constexpr double jump_slack = 0.02;     // m
inline constexpr double turn_slack = 0.1;      // rad
inline constexpr double max_sample_age = 0.1;  // s; without a sample for longer the head is not tracked

enum class HeadStatus : std::uint8_t {
    tracked,
    held,   // at the last tracked pose
    faded,  // on the way to the fixed head, or at it
};

struct FilteredHead {
    Pose pose;
    HeadStatus status = HeadStatus::faded;
};

struct HeadFilterState {
    std::optional<HeadSample> accepted;              // the newest accepted sample
    std::optional<HeadSample> jump_start, jump_end;  // first and newest sample after a jump, not yet accepted
    std::optional<HeadSample> return_from;           // end of a dropout or a jump, and the pose shown then
    std::optional<FilteredHead> shown;               // the last result
};

// The head at the time `now`, which never decreases from call to call. `samples`: those since the last call,
// oldest first; samples that are not finite or not newer than the newest one are ignored. The result depends
// on the arguments alone. Dropouts, jumps and returns cause no step of the pose. While the head is tracked
// and no return is in progress, the pose is that of the newest accepted sample, without smoothing.
FilteredHead filter_head(HeadFilterState& state, const HeadFilterSettings& settings,
                         std::span<const HeadSample> samples, double now);

}  // namespace bolt::tracking
