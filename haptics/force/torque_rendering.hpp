// Renders a bolt's torque on a device with a smaller range: scaled so that the largest torque of the lesson
// stays within it; as a torque if the device has one, otherwise as a force at the wrench's grip.
#pragma once

#include "haptics/force/output_limits.hpp"

namespace bolt::force {

struct TorqueRendering {
    double scale = 1.0;     // device torque / true torque; 0: none
    double as_force = 0.0;  // N at the grip per N·m; the physical value is 1/handle length
};

// The scales never exceed the physical values. `greatest_torque` in N·m, at least 1 is assumed;
// `handle_length` in m.
TorqueRendering make_torque_rendering(const OutputLimits& limits, double greatest_torque,
                                      double handle_length);

// `torque` in N·m about `axis` (unit): positive torque, which resists tightening of a right-hand thread,
// turns the hand about +axis. `handle` is the unit vector from the bolt to the grip.
OutputCommand render_torque(const TorqueRendering& rendering, double torque, const Vec3& axis,
                            const Vec3& handle);

// J that the device can return of the energy in a spring of `stiffness` (N·m/rad) under this torque.
double stored_torque(const TorqueRendering& rendering, double torque, double stiffness, double handle_length);

}  // namespace bolt::force
