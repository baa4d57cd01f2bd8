#include "haptics/force/torque_rendering.hpp"

#include <algorithm>

namespace bolt::force {

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

double stored_torque(const TorqueRendering& r, double torque, double stiffness, double handle_length) {
    const double whole = 0.5 * torque * torque / stiffness;
    // A rotation moves the grip by handle_length, so the force's work is as_force · handle_length of the
    // torque's.
    return whole * (r.scale + r.as_force * handle_length);
}

}  // namespace bolt::force
