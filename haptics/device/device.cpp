#include "haptics/device/device.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "engine/base/steady_seconds.hpp"

namespace bolt::device {

Timer steady_timer() {
    return {steady_seconds,
            [](double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }};
}

Timer virtual_timer(VirtualTime& time) {
    return {[&time] { return time.now; }, [&time](double seconds) { time.now += std::max(0.0, seconds); }};
}

namespace {

std::string sensing_text(const Description& d) {
    switch (d.sensing) {
        case Sensing::pose:
            return d.senses_rotation ? "senses the pose of the hand in six degrees of freedom"
                                     : "senses the position of the hand in three degrees of freedom";
        case Sensing::velocity:
            return "senses a commanded velocity in six degrees of freedom";
        case Sensing::angle:
            return "senses the angle of its one axis";
    }
    return {};
}

std::string reach_text(const Vec3& reach) {
    if (reach == Vec3(0.0)) return {};
    return fmt::format(", within {:.0f} x {:.0f} x {:.0f} cm", 200.0 * reach.x, 200.0 * reach.y,
                       200.0 * reach.z);
}

std::string rendering_text(const Description& d) {
    const auto axes = [&](int first) {
        return std::count(d.renders.begin() + first, d.renders.begin() + first + 3, true);
    };
    std::string text;
    if (const auto n = axes(0); n > 0 && d.limits.force > 0.0)
        text += fmt::format("force along {} {}, {:.3g} N at most, as stiff as {:.2g} N/mm", n,
                            n == 1 ? "axis" : "axes", d.limits.force, 1e-3 * d.limits.stiffness);
    if (const auto n = axes(3); n > 0 && d.limits.torque > 0.0)
        text += fmt::format("{}torque about {} {}, {:.3g} N·m at most", text.empty() ? "" : "; ", n,
                            n == 1 ? "axis" : "axes", d.limits.torque);
    return text.empty() ? "renders no force" : "renders " + text;
}

}  // namespace

force::OutputCommand clamp_to_limits(const Description& d, force::OutputCommand command) {
    for (int i = 0; i < 3; ++i) {
        if (!d.renders[static_cast<std::size_t>(i)]) command.force[i] = 0.0;
        if (!d.renders[static_cast<std::size_t>(i) + 3]) command.torque[i] = 0.0;
    }
    return {force::clamp_length(command.force, d.limits.force),
            force::clamp_length(command.torque, d.limits.torque)};
}

std::vector<std::string> summary_lines(const Description& d) {
    std::vector<std::string> lines;
    std::string unit = d.model.empty() ? "" : "model " + d.model;
    if (!d.serial.empty()) unit += (unit.empty() ? "serial number " : ", serial number ") + d.serial;
    if (!unit.empty()) lines.push_back(unit);
    lines.push_back(fmt::format("{}{}, {:.0f} times a second{}; {}{} button{}", sensing_text(d),
                                reach_text(d.half_workspace), d.rate,
                                d.silent_at_rest || d.sensing == Sensing::velocity ? " while it moves" : "",
                                d.senses_gripper ? "a gripper, " : "", d.buttons, d.buttons == 1 ? "" : "s"));
    lines.push_back(rendering_text(d));
    lines.insert(lines.end(), d.remarks.begin(), d.remarks.end());
    return lines;
}

std::vector<std::string> summary_lines(const DeviceHealth& health) {
    std::vector<std::string> lines;
    if (health.calibrated)
        lines.emplace_back(*health.calibrated ? "calibrated" : "not calibrated: its position is unknown");
    if (health.heat)
        lines.push_back(fmt::format("motors at {:.0f} % of their greatest heat{}", 100.0 * *health.heat,
                                    health.cooling    ? ": no force until they are cool"
                                    : is_warm(health) ? ": rest the arm"
                                                      : ""));
    return lines;
}

Error lost_device_error(std::string what, std::string expected) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = std::move(what);
    error.expected = std::move(expected);
    error.lost = true;
    return error;
}

Error unprepared_device_error(std::string what, std::string expected, Preparation preparation) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = std::move(what);
    error.expected = std::move(expected);
    set_preparation(error, std::move(preparation));
    return error;
}

Error move_permission_error(const std::string& name, std::string_view id) {
    return unprepared_device_error(
        name + " has to move by itself to find its position, and may not",
        fmt::format("free room around it, then `boltwright devices --device {} --yes`", id),
        {DeviceNeed::permission, {}});
}

}  // namespace bolt::device
