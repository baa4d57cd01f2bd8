// Rounds numbers before they are written, so that differences in the last bit between compilers or math
// libraries do not change a file. Negative zero becomes zero.
#pragma once

#include <cmath>
#include <glm/vec3.hpp>

#include "engine/base/math.hpp"

namespace bolt::sculpt {

inline constexpr double micron = 1e-6;
inline constexpr double fine = 1.0 / 65536.0;  // for directions and texture coordinates

inline double rounded(double x, double step) { return std::round(x / step) * step + 0.0; }

inline Vec3 rounded(const Vec3& p, double step) {
    return {rounded(p.x, step), rounded(p.y, step), rounded(p.z, step)};
}

}  // namespace bolt::sculpt
