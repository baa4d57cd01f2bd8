#include "haptics/force/device_mapping.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bolt::force {

namespace {

constexpr double swing = to_radians(60.0);  // of a wrench between two positions of its jaw on a hexagon
constexpr double used_reach = 0.9;          // share of the reach: many arms are less stiff at its edge

Quat device_to_assembly_rotation(const WorkspaceMap& w, const WorkspaceState& s) {
    return s.heading * w.rotation;
}

}  // namespace

Vec3 lever_end(const WorkspaceState& s, const Pose& tool) { return tool * Vec3(s.lever_arm, 0.0, 0.0); }

Pose device_in_assembly(const WorkspaceMap& w, const WorkspaceState& s) {
    return {s.centre, device_to_assembly_rotation(w, s)};
}

void realign(const WorkspaceMap& w, WorkspaceState& s, const Pose& device, const Pose& tool) {
    const Quat device_to_assembly = device_to_assembly_rotation(w, s);
    s.centre = lever_end(s, tool) - w.scale * (device_to_assembly * device.position);
    s.tool_to_device =
        glm::normalize(glm::conjugate(device_to_assembly * device.orientation) * tool.orientation);
    s.commanded_tool = tool;
}

WorkspaceState align_workspace(const WorkspaceMap& w, const Pose& device, const Pose& tool) {
    WorkspaceState state;
    realign(w, state, device, tool);
    return state;
}

Pose to_assembly(const WorkspaceMap& w, WorkspaceState& s, const Pose& device, bool clutch, double dt) {
    // The watchdog rejects a pose that is not finite; it must not enter the state.
    const Vec3& p = device.position;
    const Quat& q = device.orientation;
    if (!std::isfinite(p.x + p.y + p.z + q.w + q.x + q.y + q.z)) return device;
    const double step = w.fade > 0.0 ? dt / w.fade : 1.0;
    s.force_share = std::clamp(s.force_share + (clutch ? -step : step), 0.0, 1.0);
    if (clutch) {
        realign(w, s, device, s.commanded_tool);
    } else {
        const Quat device_to_assembly = device_to_assembly_rotation(w, s);
        if (std::isfinite(w.return_time)) {
            const double kept = 1.0 - std::min(1.0, dt / w.return_time);
            s.centre *= kept;
            if (s.lever_arm == 0.0)
                s.tool_to_device = glm::normalize(rotation(kept * rotation_vector(s.tool_to_device)));
        }
        s.commanded_tool.orientation =
            glm::normalize(device_to_assembly * device.orientation * s.tool_to_device);
        s.commanded_tool.position = s.centre + w.scale * (device_to_assembly * device.position) -
                                    s.commanded_tool.orientation * Vec3(s.lever_arm, 0.0, 0.0);
    }
    return s.commanded_tool;
}

Pose pivoted(const Pivot& pivot, const Pose& held, double lever_arm, const Vec3& lever_end) {
    const auto across = [&](const Vec3& v) { return v - glm::dot(v, pivot.axis) * pivot.axis; };
    const Vec3 from = across(held.orientation * Vec3(1.0, 0.0, 0.0));
    const Vec3 to = across(lever_end - pivot.centre);
    Pose tool = held;
    if (glm::length(from) > 1e-6 && glm::length(to) > 1e-6) {
        const double angle = std::atan2(glm::dot(pivot.axis, glm::cross(from, to)), glm::dot(from, to));
        tool.orientation = glm::normalize(glm::angleAxis(angle, pivot.axis) * held.orientation);
    }
    tool.position = lever_end - tool.orientation * Vec3(lever_arm, 0.0, 0.0);
    return tool;
}

double fitted_scale(const Vec3& reach, double handle_length) {
    // Half the chord of the arc, along x, and half its height, along z.
    const double chord = handle_length * std::sin(0.5 * swing);
    const double height = 0.5 * handle_length * (1.0 - std::cos(0.5 * swing));
    double scale = 1.0;
    if (reach.x > 0.0) scale = std::max(scale, chord / (used_reach * reach.x));
    if (reach.z > 0.0) scale = std::max(scale, height / (used_reach * reach.z));
    return scale;
}

Vec3 rotated_half_workspace(const Quat& rotation, const Vec3& reach) {
    constexpr double negligible = 1e-6;  // component of a unit vector: less than a micrometre in a metre
    Vec3 rotated(std::numeric_limits<double>::infinity());
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 along(0.0);
        along[axis] = 1.0;
        along = glm::conjugate(rotation) * along;
        for (int i = 0; i < 3; ++i)
            if (std::abs(along[i]) > negligible)
                rotated[axis] = std::min(rotated[axis], reach[i] / std::abs(along[i]));
    }
    return rotated;
}

OutputCommand to_device(const WorkspaceMap& w, const WorkspaceState& s, const OutputCommand& on_tool) {
    const Quat back = glm::conjugate(device_to_assembly_rotation(w, s));
    return {back * on_tool.force * (s.force_share * w.power_ratio * w.scale),
            back * on_tool.torque * (s.force_share * w.power_ratio)};
}

OutputLimits in_assembly(const WorkspaceMap& w, const OutputLimits& device) {
    OutputLimits limits = device;
    const double force = w.power_ratio * w.scale, stiffness = force * w.scale, torque = w.power_ratio;
    limits.force /= force;
    limits.force_slew_rate /= force;
    limits.stiffness /= stiffness;
    limits.damping /= stiffness;
    limits.torque /= torque;
    limits.torque_slew_rate /= torque;
    limits.torsion /= torque;
    limits.angular_damping /= torque;
    limits.speed *= w.scale;
    limits.jump *= w.scale;
    return limits;
}

namespace {

constexpr double used_torque_share = 0.8;  // of the device's range that the largest torque of the lesson uses

}  // namespace

TorqueRendering make_torque_rendering(const OutputLimits& limits, double max_torque, double handle_length) {
    const double range = std::max(max_torque, 1.0);
    if (limits.torque > 0.0) return {std::min(1.0, used_torque_share * limits.torque / range), 0.0};
    return {0.0, std::min(1.0 / handle_length, used_torque_share * limits.force / range)};
}

OutputCommand render_torque(const TorqueRendering& r, double torque, const Vec3& loosening_axis,
                            const Vec3& handle) {
    return {glm::cross(loosening_axis, handle) * (torque * r.as_force), loosening_axis * (torque * r.scale)};
}

double stored_torque_energy(const TorqueRendering& r, double torque, double stiffness, double handle_length) {
    const double whole = 0.5 * torque * torque / stiffness;
    // A rotation moves the end of the handle by handle_length per radian, so the force does as_force ·
    // handle_length times the work of the torque.
    return whole * (r.scale + r.as_force * handle_length);
}

}  // namespace bolt::force
