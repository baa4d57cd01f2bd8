// A bolt's torque on a device that has less, or none: scaled so that the greatest one asked for stays within
// its range; as a torque where the device can, as a force at the wrench's grip where it cannot.
#pragma once

#include "haptics/force/output_limits.hpp"

namespace bolt::force {

struct TorqueRendering {
    double scale = 1.0;     // device torque / true torque; 0: none
    double as_force = 0.0;  // N at the grip per N·m; the true force at arm's length is 1/handle length
};

// Never above what is true. `handle_length` in m.
TorqueRendering make_torque_rendering(const OutputLimits& limits, double greatest_torque,
                                      double handle_length);

// `torque` about `axis` (unit), counted against it: what resists a right-hand thread being tightened turns
// the hand about +axis. `handle` (unit): from the bolt to the grip.
OutputCommand render_torque(const TorqueRendering& rendering, double torque, const Vec3& axis,
                            const Vec3& handle);

// J that the device gives back of what a spring of `stiffness` (N·m/rad) under this torque holds.
double stored_torque(const TorqueRendering& rendering, double torque, double stiffness, double handle_length);

}  // namespace bolt::force
