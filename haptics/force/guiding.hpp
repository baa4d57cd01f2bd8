// The guiding force: towards the target, inversely proportional to its distance, as the 2018 paper has it,
// made sound.
#pragma once

#include "engine/base/math.hpp"

namespace bolt::force {

struct Guiding {
    double gain = 0.018;       // k of F = k/d, N·m
    double stiffness = 500.0;  // K_max, N/m: what the device renders stably
    double reach = 0.5;        // m: beyond it the force fades out to nothing over the same distance again
};

// k/d has the local stiffness k/d²: below d_min = √(k/K_max) it is replaced by the spring K_max d through the
// target. Force and potential are continuous; the greatest force is √(k K_max).
Vec3 guiding_force(const Guiding& guiding, const Vec3& tool, const Vec3& target);

}  // namespace bolt::force
