// Uniformly distributed random rotations and directions.
#pragma once

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"

namespace bolt {

inline Quat random_turn(Random& random) {
    return glm::normalize(Quat(random.normal(), random.normal(), random.normal(), random.normal()));
}

inline Vec3 random_direction(Random& random) { return random_turn(random) * Vec3(1, 0, 0); }

}  // namespace bolt
