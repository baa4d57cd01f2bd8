#include "game/station/controller_tip.hpp"

#include <fmt/format.h>

#include <utility>

namespace bolt::station_setup {

namespace {

constexpr double controller_period = 5e-3;  // s; trackers send about 100 poses a second or more

}  // namespace

ControllerTip::ControllerTip(ControllerIo io, const Vec3& tip, const TouchOptions& options)
    : io_(std::move(io)), tip_(tip), options_(options) {}

// Waits for one polling period, then reads.
Result<ControllerSample> ControllerTip::next_sample() {
    io_.timer.wait(controller_period);
    if (io_.stop()) return fail(ErrorCode::failed, "the registration was interrupted", {});
    BOLT_TRY_ASSIGN(const ControllerSample sample, io_.read());
    if (!origin_moves_) origin_moves_ = sample.origin_moves;
    if (sample.origin_moves != *origin_moves_)
        return fail(ErrorCode::failed, "the headset was recentred while points were measured",
                    "one origin for all points: measure them again");
    return sample;
}

// A press while the controller is not tracked measures no position, so the reason is shown once more.
Status ControllerTip::wait_for_press() {
    (void)io_.confirmed();  // an earlier press of Enter does not count
    bool held = true;       // a button that is already held does not count
    bool shown = false;     // the message that the controller is not tracked
    double tracked_time = io_.timer.now();
    while (true) {
        BOLT_TRY_ASSIGN(const ControllerSample sample, next_sample());
        const bool was_held = std::exchange(held, sample.pressed);
        const bool pressed = (sample.pressed && !was_held) || io_.confirmed();
        if (sample.pose) {
            if (std::exchange(shown, false))
                io_.show(fmt::format("The {} is tracked again.", io_.device.name));
            tracked_time = io_.timer.now();
            if (pressed) return {};
        } else if (pressed || (!shown && io_.timer.now() - tracked_time > options_.max_silence)) {
            io_.show(sample.fault.empty()
                         ? fmt::format("The {} is not tracked: {}.", io_.device.name, io_.device.remedy)
                         : fmt::format("No pose: {}.", sample.fault));
            shown = true;
        }
    }
}

// Empty if tracking failed, even for a moment: the poses around such a gap are unreliable.
Result<std::vector<Pose>> ControllerTip::tracked_poses(double seconds) {
    std::vector<Pose> poses;
    bool tracked = true;
    for (const double end = io_.timer.now() + seconds; io_.timer.now() < end;) {
        BOLT_TRY_ASSIGN(const ControllerSample sample, next_sample());
        tracked = tracked && sample.pose;
        if (sample.pose) poses.push_back(*sample.pose);
    }
    if (!tracked) poses.clear();
    return poses;
}

Result<PivotFit> ControllerTip::find_tip(const PivotRequest& pivot) {
    while (true) {
        io_.show(
            fmt::format("Hold {} on a fixed point, {}, and turn {} about the tip in all directions for "
                        "{:.0f} s; the tip must not slip.",
                        pivot.tip, io_.device.press, pivot.turned, pivot_time));
        BOLT_TRY(wait_for_press());
        BOLT_TRY_ASSIGN(const std::vector<Pose> poses, tracked_poses(pivot_time));
        const Result<PivotFit> fit = fit_pivot(poses);
        if (fit && fit->rms <= pivot.max_rms) {
            tip_ = fit->tip;
            io_.show(
                fmt::format("The tip is at {:.4f},{:.4f},{:.4f} m in the frame of the grip; rms {:.1f} mm.",
                            tip_.x, tip_.y, tip_.z, fit->rms / mm));
            return fit;
        }
        io_.show(fmt::format(
            "{}. Once more.",
            poses.empty() ? fmt::format("The {} was not tracked all the time", io_.device.name)
            : fit         ? fmt::format("The tip has slipped: its rms is {:.1f} mm; expected at most {:.1f}",
                                        fit->rms / mm, pivot.max_rms / mm)
                          : fit.error().message()));
    }
}

Result<Vec3> ControllerTip::touch(std::size_t number, std::string_view request) {
    while (true) {
        io_.show(request);
        BOLT_TRY(wait_for_press());
        BOLT_TRY_ASSIGN(const std::vector<Pose> poses, tracked_poses(options_.duration));
        std::vector<Vec3> touched;
        for (const Pose& pose : poses) touched.push_back(pose * tip_);
        Result<Vec3> mean = average_touch(touched, options_);
        if (mean) {
            io_.show(fmt::format("Point {}: measured with the controller.", number + 1));
            return mean;
        }
        io_.show(fmt::format(
            "Point {}: {}. Once more.", number + 1,
            touched.empty() ? "the controller was not tracked all the time" : mean.error().message()));
    }
}

Result<std::vector<PointPair>> measure_fingertips(ControllerTip& controller,
                                                  const std::function<Result<hand::Skeleton>()>& fingers) {
    struct Fingertip {
        hand::Joint joint;
        std::string_view name;
    };
    constexpr Fingertip fingertips[] = {{hand::thumb_tip, "the tip of the thumb"},
                                        {hand::index_tip, "the tip of the index finger"},
                                        {hand::middle_tip, "the tip of the middle finger"},
                                        {hand::little_tip, "the tip of the little finger"},
                                        {hand::ring_tip, "the tip of the ring finger"}};
    std::vector<PointPair> pairs;
    for (const Fingertip& fingertip : fingertips) {
        BOLT_TRY_ASSIGN(const PivotFit fit,
                        controller.find_tip({fingertip.name, "the stiff hand", max_fingertip_rms}));
        BOLT_TRY_ASSIGN(const hand::Skeleton joints, fingers());
        pairs.push_back({joints.position[fingertip.joint], fit.tip});
    }
    return pairs;
}

Result<std::vector<PointPair>> measure_pairs(ArmTip& arm, ControllerTip& controller, std::size_t count) {
    std::vector<PointPair> pairs;
    for (std::size_t i = 0; i < count; ++i) {
        const std::string point = fmt::format("Point {} of {}: ", i + 1, count);
        BOLT_TRY_ASSIGN(
            const Vec3 to,
            controller.touch(i, point + "touch a point with the tip of the controller, hold still, "
                                        "and press its trigger or Enter."));
        BOLT_TRY_ASSIGN(const Vec3 from,
                        arm.touch(i, point + "touch the same point with the tip of the arm, hold still, and "
                                             "press a button of the arm or Enter."));
        pairs.push_back({from, to});
    }
    return pairs;
}

}  // namespace bolt::station_setup
