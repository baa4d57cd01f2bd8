#include "haptics/force/device_mapping.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

WorkspaceState align_workspace(const WorkspaceMap& w, const Pose& device, const Pose& tool) {
    WorkspaceState state;
    state.centre = tool.position - w.scale * (w.turn * device.position);
    state.grip = glm::normalize(glm::conjugate(w.turn * device.orientation) * tool.orientation);
    state.tool = tool;
    return state;
}

Pose to_assembly(const WorkspaceMap& w, WorkspaceState& s, const Pose& device, bool clutch, double dt) {
    // The watchdog rejects a pose that is not finite; it must not enter the state.
    const Vec3& p = device.position;
    const Quat& q = device.orientation;
    if (!std::isfinite(p.x + p.y + p.z + q.w + q.x + q.y + q.z)) return device;
    const double step = w.fade > 0.0 ? dt / w.fade : 1.0;
    s.share = std::clamp(s.share + (clutch ? -step : step), 0.0, 1.0);
    if (clutch) {
        const double share = s.share;
        s = align_workspace(w, device, s.tool);
        s.share = share;
    } else {
        s.tool.position = s.centre + w.scale * (w.turn * device.position);
        s.tool.orientation = glm::normalize(w.turn * device.orientation * s.grip);
    }
    return s.tool;
}

OutputCommand to_device(const WorkspaceMap& w, const WorkspaceState& s, const OutputCommand& on_tool) {
    const Quat back = glm::conjugate(w.turn);
    return {back * on_tool.force * (s.share * w.power * w.scale),
            back * on_tool.torque * (s.share * w.power)};
}

OutputLimits in_assembly(const WorkspaceMap& w, const OutputLimits& device) {
    OutputLimits limits = device;
    const double force = w.power * w.scale, stiffness = force * w.scale, torque = w.power;
    limits.force /= force;
    limits.force_rate /= force;
    limits.stiffness /= stiffness;
    limits.damping /= stiffness;
    limits.torque /= torque;
    limits.torque_rate /= torque;
    limits.torsion /= torque;
    limits.angular_damping /= torque;
    limits.speed *= w.scale;
    limits.jump *= w.scale;
    return limits;
}

namespace {

constexpr double share = 0.8;  // of the device's range that the largest torque of the lesson uses

}  // namespace

TorqueRendering make_torque_rendering(const OutputLimits& limits, double greatest_torque,
                                      double handle_length) {
    const double greatest = std::max(greatest_torque, 1.0);
    if (limits.torque > 0.0) return {std::min(1.0, share * limits.torque / greatest), 0.0};
    return {0.0, std::min(1.0 / handle_length, share * limits.force / greatest)};
}

OutputCommand render_torque(const TorqueRendering& r, double torque, const Vec3& axis, const Vec3& handle) {
    return {glm::cross(axis, handle) * (torque * r.as_force), axis * (torque * r.scale)};
}

double stored_torque_energy(const TorqueRendering& r, double torque, double stiffness, double handle_length) {
    const double whole = 0.5 * torque * torque / stiffness;
    // A rotation moves the grip by handle_length, so the force's work is as_force · handle_length of the
    // torque's.
    return whole * (r.scale + r.as_force * handle_length);
}

}  // namespace bolt::force
