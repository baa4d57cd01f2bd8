#include "haptics/force/workspace.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

WorkspaceState place(const Workspace& w, const Pose& device, const Pose& tool) {
    WorkspaceState state;
    state.centre = tool.position - w.scale * (w.turn * device.position);
    state.grip = glm::normalize(glm::conjugate(w.turn * device.orientation) * tool.orientation);
    state.tool = tool;
    return state;
}

Pose to_assembly(const Workspace& w, WorkspaceState& s, const Pose& device, bool clutch, double dt) {
    // The watchdog rejects a pose that is not finite; it must not enter the state.
    const Vec3& p = device.position;
    const Quat& q = device.orientation;
    if (!std::isfinite(p.x + p.y + p.z + q.w + q.x + q.y + q.z)) return device;
    const double step = w.fade > 0.0 ? dt / w.fade : 1.0;
    s.share = std::clamp(s.share + (clutch ? -step : step), 0.0, 1.0);
    if (clutch) {
        const double share = s.share;
        s = place(w, device, s.tool);
        s.share = share;
    } else {
        s.tool.position = s.centre + w.scale * (w.turn * device.position);
        s.tool.orientation = glm::normalize(w.turn * device.orientation * s.grip);
    }
    return s.tool;
}

OutputCommand to_device(const Workspace& w, const WorkspaceState& s, const OutputCommand& on_tool) {
    const Quat back = glm::conjugate(w.turn);
    return {back * on_tool.force * (s.share * w.power * w.scale),
            back * on_tool.torque * (s.share * w.power)};
}

OutputLimits in_assembly(const Workspace& w, const OutputLimits& device) {
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

}  // namespace bolt::force
