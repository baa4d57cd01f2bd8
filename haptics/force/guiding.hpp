// The law of the guiding force: towards the target and inversely proportional to its distance, as in the
// paper of 2018, but bounded and with limited stiffness; and the torque that aligns a jaw with a hexagon.
// guide.hpp plans the path.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::force {

struct GuidingParameters {
    double gain = 0.1;         // k of F = k/d, N·m: 1 N at 10 cm
    double stiffness = 500.0;  // K_max, N/m, that the device renders stably
    double reach = 1.0;        // m; between reach and 2 · reach the force fades to zero
    double greatest = 3.0;     // N, largest force
    double torque = 0.2;       // N·m, largest aligning torque
    double near = 0.08;        // m to the target within which the torque acts
    double strength = 1.0;     // 0 … 1, share of the force that the lesson's mode allows
    double slew = 4.0;         // 1/s, rate at which the force fades in and out
};

// k/d has the local stiffness k/d². Below d_min = √(k/K_max) the spring K_max d replaces it, and both are
// capped. Force and potential are continuous; the largest force is √(k K_max) or the cap. `distance` in m.
double guiding_pull(const GuidingParameters& guiding, double distance);  // N
Vec3 guiding_force(const GuidingParameters& guiding, const Vec3& tool, const Vec3& target);

// Potential of guiding_pull, J, 0 at the target.
double guiding_potential(const GuidingParameters& guiding, double distance);

// Orientation of a nut's hexagon: orthogonal unit vectors. A jaw fits with its direction along `flat` or
// turned from it about `axis` by a multiple of 60°.
struct Hexagon {
    Vec3 axis{0.0, 1.0, 0.0};
    Vec3 flat{1.0, 0.0, 0.0};
    Vec3 across{0.0, 0.0, -1.0};
};

// The torque, N·m, that turns the jaw to the nearest of the six orientations and its normal parallel or
// antiparallel to the axis. Gradient of a smooth potential, so it is continuous where the nearest orientation
// changes: with z the jaw's direction projected along the axis as a complex number, n the normal and a the
// axis, V = greatest/6 (1 − Re z⁶) + greatest (1 − (n·a)²).
Vec3 aligning_torque(double greatest, const Hexagon& hexagon, const Vec3& jaw, const Vec3& normal);
double aligning_potential(double greatest, const Hexagon& hexagon, const Vec3& jaw, const Vec3& normal);

}  // namespace bolt::force
