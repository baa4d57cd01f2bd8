#include "haptics/force/guiding.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

Vec3 guiding_force(const Guiding& guiding, const Vec3& tool, const Vec3& target) {
    const Vec3 away = target - tool;
    const double d = glm::length(away);
    const double d_min = std::sqrt(guiding.gain / guiding.stiffness);
    if (d <= d_min) return guiding.stiffness * away;
    const double fade = std::clamp(2.0 - d / guiding.reach, 0.0, 1.0);
    return away * (fade * guiding.gain / square(d));
}

}  // namespace bolt::force
