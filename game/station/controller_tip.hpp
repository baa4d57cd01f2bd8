// Measures points of the user's choice in two frames: the user touches each point with the tip of a tracked
// controller and with the tip of an arm. No mark with a known position is needed.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "game/station/point_source.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::station_setup {

// A controller as its tracker reports it now.
struct ControllerSample {
    std::optional<Pose> pose;        // of its grip, in the tracker's frame; none: it is not tracked
    bool pressed = false;            // its button
    std::uint32_t origin_moves = 0;  // times that the origin of the tracker's frame was moved
    std::string fault;               // why there is no pose; empty: not known
};

// Words for the device in prompts to the user.
struct DeviceWords {
    std::string_view name = "controller";
    std::string_view press = "press the trigger of the controller or Enter";
    std::string_view remedy = "switch it on, and hold it where the headset sees it";
};
inline constexpr DeviceWords vive_tracker_words{"Vive tracker", "press Enter",
                                                "switch it on, and hold it where its base stations see it"};

// The functions of the program that a touch with a controller calls. Tests replace them, as they do TouchIo.
struct ControllerIo {
    std::function<Result<ControllerSample>()> read;  // fails if the tracker is lost
    std::function<bool()> confirmed;                 // Enter was pressed since the last call
    std::function<bool()> stop;                      // the user ends the program
    std::function<void(std::string_view)> show;      // a line for the user
    device::Timer timer;
    DeviceWords device{};
};

// Permits more motion than for an arm, because optical trackers have a noise of about a millimetre, which the
// mean removes. A controller that is not tracked for max_silence is reported.
inline constexpr TouchOptions controller_touch{0.3, 3.0e-3, 5, 1.0};

// Time, s, for which the user turns the controller about its tip, and limit of the rms, m, of the tip's fit.
// A tip that has slipped by some millimetres exceeds the limit.
inline constexpr double pivot_time = 6.0, max_pivot_rms = 2.0e-3;

// A tip that stays on a fixed point while the user turns the object to which it belongs.
struct PivotRequest {
    // Names of the tip and the object in requests to the user.
    std::string_view tip = "the tip of the controller", turned = "the controller";
    double max_rms = max_pivot_rms;  // m
};

// The tip of a controller, in the tracker's frame: the user touches a point and presses the controller's
// button or Enter. The position is averaged; if the hand moved, or the controller was not tracked meanwhile,
// the user must touch the point again. While the controller is not tracked, the program reports it and waits.
class ControllerTip {
  public:
    // `tip`: m, in the frame of the grip.
    ControllerTip(ControllerIo io, const Vec3& tip, const TouchOptions& options = controller_touch);

    // Measures the position of a tip in the frame of the grip, and uses it in all later touches: the user
    // keeps the tip on one point and turns the controller about it. Repeats this if the turns do not
    // determine the tip, or if the tip has slipped.
    Result<PivotFit> find_tip(const PivotRequest& pivot = {});

    // Shows `request` and waits until point `number`, from 0, is measured. Fails if the tracker is lost, its
    // origin has moved since the first sample, or the user interrupts.
    Result<Vec3> touch(std::size_t number, std::string_view request);

  private:
    Result<ControllerSample> next_sample();
    Status wait_for_press();
    Result<std::vector<Pose>> tracked_poses(double seconds);

    ControllerIo io_;
    Vec3 tip_;
    TouchOptions options_;
    std::optional<std::uint32_t> origin_moves_;  // at the first sample
};

// m, limit of the rms of a fingertip's fit: the skin yields, and the finger bends a little.
inline constexpr double max_fingertip_rms = 5.0e-3;

// Measures the fingertips of a gloved hand to which the controller is fixed: the user turns the hand about
// each fingertip. PointPair::from is the fingertip in the frame of the wrist, from the skeleton that
// `fingers` returns after the turn; PointPair::to is in the frame of the grip. The last pair, the check
// point, is that of the ring finger. Fails if `fingers` fails, the tracker is lost, or the user interrupts.
Result<std::vector<PointPair>> measure_fingertips(ControllerTip& controller,
                                                  const std::function<Result<hand::Skeleton>()>& fingers);

// Measures `count` points, each with the controller first and then with the arm: PointPair::from is in the
// frame of the arm, PointPair::to in that of the tracker.
Result<std::vector<PointPair>> measure_pairs(ArmTip& arm, ControllerTip& controller, std::size_t count);

}  // namespace bolt::station_setup
