// The guiding force: towards the target, inversely proportional to its distance, as the 2018 paper has it,
// made sound; and the torque that turns a jaw onto its hexagon. Where it leads is guide.hpp's.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::force {

struct Guiding {
    double gain = 0.1;         // k of F = k/d, N·m: a newton at 10 cm
    double stiffness = 500.0;  // K_max, N/m: what the device renders stably
    double reach = 1.0;        // m: beyond it the force fades out to nothing over the same distance again
    double greatest = 3.0;     // N: it leads, it does not drag
    double torque = 0.2;       // N·m, the greatest that aligns
    double near = 0.08;        // m from the target within which it aligns
    double strength = 1.0;     // 0 … 1: how much help the lesson gives
    double slew = 4.0;         // 1/s: help comes and goes in a quarter of a second
};

// k/d has the local stiffness k/d²: below d_min = √(k/K_max) it is replaced by the spring K_max d through the
// target, and both are capped. Force and potential are continuous; the greatest force is √(k K_max) or the
// cap.
double guiding_pull(const Guiding& guiding, double distance);  // N
Vec3 guiding_force(const Guiding& guiding, const Vec3& tool, const Vec3& target);

// J, 0 at the target: what the hand gets on its way there.
double guiding_potential(const Guiding& guiding, double distance);

// Six ways of a jaw on a nut: `flat` and `across` are two directions square to the axis and to each other; a
// jaw fits with its direction along `flat`, or turned from it by any sixth of a turn.
struct Hexagon {
    Vec3 axis{0.0, 1.0, 0.0};
    Vec3 flat{1.0, 0.0, 0.0};
    Vec3 across{0.0, 0.0, -1.0};
};

// Turns the jaw to the nearest of the six, and its normal along the axis or against it, whichever is nearer.
// Both are gradients of one smooth potential, so nothing jumps where the nearest one changes: with z the
// jaw's direction seen along the axis as a complex number, that is greatest/6 (1 - Re z⁶) + greatest (1 -
// (n·a)²).
Vec3 aligning_torque(double greatest, const Hexagon& hexagon, const Vec3& jaw, const Vec3& normal);
double aligning_potential(double greatest, const Hexagon& hexagon, const Vec3& jaw, const Vec3& normal);

}  // namespace bolt::force
