#include "haptics/device/open_haptics_frame.hpp"

#include <algorithm>
#include <cmath>
#include <glm/mat3x3.hpp>

namespace bolt::device::open_haptics {

namespace {

// hdDefines.h. Lengths are in mm.
constexpr unsigned get_buttons = 0x2000, get_transform = 0x2052, get_motor_heat = 0x2605, set_force = 0x2700;

// s; a command older than this renders no force, because the device thread then hangs. The force may last two
// more frames, so it ends at most 20 ms after the last command.
constexpr double max_command_age = 18e-3;
constexpr double fade_time = 10e-3;  // s from full strength to none after an error of the forces
constexpr double pause_time = 0.5;   // s without such an error before the force returns
constexpr double ramp_time = 0.5;    // s from none to full strength
// Heat of the motors, 0 … 1. From `hot` on the forces fade, before the library ends them with an error at 1;
// below `cool` they return.
constexpr double hot = 0.95, cool = 0.7;
constexpr int heat_interval = 20;     // frames between two queries of the heat
constexpr double max_distance = 2.0;  // m from the origin; a position beyond is invalid

// The pose in the vendor's transform, a column-major matrix; nullopt if the pose is implausible.
std::optional<Pose> pose_in(const Doubles& m, bool with_rotation) {
    Pose pose{mm * Vec3(m[12], m[13], m[14]), {1.0, 0.0, 0.0, 0.0}};
    if (!(glm::length(pose.position) < max_distance)) return {};
    if (!with_rotation) return pose;
    const glm::dmat3 turned(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    const glm::dmat3 error = glm::transpose(turned) * turned - glm::dmat3(1.0);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (!(std::abs(error[i][j]) < 1e-2)) return {};
    if (glm::determinant(turned) < 0.0) return {};
    pose.orientation = glm::normalize(glm::quat_cast(turned));
    return pose;
}

}  // namespace

Doubles get_doubles(const OpenHapticsApi& api, unsigned what) {
    Doubles values;
    values.fill(nan);
    api.get_doubles(what, values.data());
    return values;
}

int get_integer(const OpenHapticsApi& api, unsigned what) {
    std::array<int, 16> values{};
    api.get_integers(what, values.data());
    return values[0];
}

unsigned FrameCallback::run(void* self) {
    constexpr unsigned continues = 1;
    static_cast<FrameCallback*>(self)->run_frame();
    return continues;
}

void FrameCallback::run_frame() {
    const double now = timer_.now();
    const double elapsed = std::max(now - before_, 0.0);
    before_ = report_.time = now;
    if (elapsed > max_frame_age) strength_ = 0.0;
    api_.begin_frame(id_);
    if (report_.calibration == calibrated) {
        const std::optional<Pose> pose = pose_in(get_doubles(api_, get_transform), arm_.senses_rotation);
        if (pose) take_sample(*pose, now);
        render(pose.has_value(), now, elapsed);
    } else {
        calibrate();
    }
    api_.end_frame(id_);
    take_errors(api_, [&](unsigned code) { note_error(code, now); });
    reports.write(report_);
}

// The forces are off until the arm is calibrated, because its position may jump then.
void FrameCallback::calibrate() {
    report_.calibration = api_.check_calibration();
    if (report_.calibration == needs_update) api_.update_calibration(arm_.calibration_style);
    if (report_.calibration == calibrated) api_.enable(force_output);
}

void FrameCallback::take_sample(const Pose& pose, double now) {
    constexpr unsigned known_buttons = (1U << max_buttons) - 1U;
    report_.sample.pose = {pose.position - arm_.centre, pose.orientation};
    report_.sample.buttons = static_cast<unsigned>(get_integer(api_, get_buttons)) & known_buttons;
    report_.sample.time = now;
    ++report_.number;
}

// Codes below warm_motors are refused calls. They do not prolong a pause, because all calls are refused until
// the forces are enabled again.
void FrameCallback::note_error(unsigned code, double now) {
    if (code >= warm_motors || now >= paused_until_) paused_until_ = now + pause_time;
    report_.cooling = report_.cooling || code == warm_motors;
    if (code >= first_fault) report_.fault = std::max(report_.fault, code);
}

void FrameCallback::observe_heat() {
    if (--frames_to_heat_ > 0) return;
    frames_to_heat_ = heat_interval;
    double hottest = -1.0;  // of the motors that are reported
    for (const double heat : get_doubles(api_, get_motor_heat))
        if (heat >= 0.0) hottest = std::max(hottest, heat);
    report_.heat = hottest >= 0.0 ? std::optional(std::min(hottest, 1.0)) : std::nullopt;
    report_.cooling = hottest >= hot || (report_.cooling && hottest >= cool);
}

bool FrameCallback::is_paused(double now) { return report_.cooling || now < paused_until_; }

void FrameCallback::update_strength(bool renders, double elapsed) {
    if (!renders) {
        strength_ = std::max(0.0, strength_ - elapsed / fade_time);
        return;
    }
    // The library may have disabled the forces after an error (not confirmed).
    if (strength_ == 0.0) api_.enable(force_output);
    strength_ = std::min(1.0, strength_ + std::min(elapsed, 2.0 * frame_time) / ramp_time);
}

void FrameCallback::render(bool has_pose, double now, double elapsed) {
    observe_heat();
    if (report_.released) return;  // the device thread may have disabled the forces
    update_strength(has_pose && !is_paused(now), elapsed);
    commands.update();
    const TimedCommand& command = commands.latest();
    const bool releases = releases_.load(std::memory_order_relaxed);
    const bool none = releases || report_.fault != 0 || now - command.time > max_command_age;
    const double share = none ? 0.0 : strength_;
    const Vec3 force = share * command.output.force;
    api_.set_doubles(set_force, &force.x);
    report_.released = releases;
}

}  // namespace bolt::device::open_haptics
