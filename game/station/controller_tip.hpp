// Points of the user's choice, touched with the tip of a tracked controller and with that of an arm: their
// positions in both frames are measured, so no mark whose place is known is needed.
#pragma once

#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "game/station/point_source.hpp"

namespace bolt::station_setup {

// A controller as its tracker reports it now.
struct ControllerSample {
    std::optional<Pose> pose;  // of its grip, in the tracker's frame; none: it is not tracked
    bool pressed = false;      // its button
};

// The functions of the program that a touch with a controller uses; tests replace them as those of TouchIo.
struct ControllerIo {
    std::function<Result<ControllerSample>()> read;  // fails if the tracker is lost
    std::function<bool()> confirmed;                 // Enter was pressed since the last call
    std::function<bool()> stop;                      // the user ends the program
    std::function<void(std::string_view)> show;      // a line for the user
    device::Timer timer;
};

// The noise of optical trackers, about a millimetre, disappears in the mean, so the limit of the motion is
// larger than that of an arm. max_silence: a controller that is not tracked for so long is reported.
inline constexpr TouchOptions controller_touch{0.3, 3.0e-3, 5, 1.0};

// The user turns the controller about its tip for so long, s. A tip that has slipped by some millimetres
// leaves a larger rms.
inline constexpr double pivot_time = 6.0, max_pivot_rms = 2.0e-3;

// The tip of a controller, in the tracker's frame: the user touches a point and presses the controller's
// button or Enter. The position is averaged; if the hand moved, or the controller was not tracked meanwhile,
// the point is asked for again. While it is not tracked, the program says so and waits.
class ControllerTip {
  public:
    // `tip`: m, in the frame of the grip.
    ControllerTip(ControllerIo io, const Vec3& tip, const TouchOptions& options = controller_touch);

    // Finds where the tip is in the frame of the grip, and takes it for the touches that follow: the user
    // keeps the tip on one point and turns the controller about it. Turns that do not determine the tip, or a
    // tip that slips, are asked for again.
    Result<PivotFit> find_tip();

    // Shows `request` and waits until point `number`, from 0, is measured. Fails if the tracker is lost or
    // the user ends it.
    Result<Vec3> touch(std::size_t number, std::string_view request);

  private:
    Result<ControllerSample> next_sample();
    Status wait_for_press();
    Result<std::vector<Pose>> tracked_poses(double seconds);

    ControllerIo io_;
    Vec3 tip_;
    TouchOptions options_;
};

// Measures `count` points, each with the controller first and then with the arm: PointPair::from is in the
// frame of the arm, PointPair::to in that of the tracker.
Result<std::vector<PointPair>> measure_pairs(ArmTip& arm, ControllerTip& controller, std::size_t count);

}  // namespace bolt::station_setup
