// The dimensions of the workshop, which its model and its environment map share, and the environment map:
// strip lights, a band of windows on the left, a warm wall on the right, a dark floor. Metres. The origin is
// the middle of the clamping plate's upper face on the bench, +Z towards the trainee.
#pragma once

#include <array>

#include "engine/assets/image.hpp"
#include "engine/base/math.hpp"

namespace bolt::sculpt::room {

inline constexpr double floor = -0.85;
inline constexpr double ceiling = 2.55;
inline constexpr double back_wall = -0.62;  // z
inline constexpr double front_wall = 4.6;   // z, behind the trainee
inline constexpr double side_wall = 3.8;    // ±x
inline constexpr double dado = 0.12;        // y of the upper edge of the wall's darker paint

// Strip lights under the ceiling, along x.
struct StripLight {
    Vec3 centre;
    double length, width;
    double radiance;
    Vec3 colour;
};
inline constexpr std::array<StripLight, 2> strip_lights{
    StripLight{{-0.25, 1.95, 0.55}, 2.4, 0.16, 26.0, {1.00, 0.97, 0.92}},
    StripLight{{0.25, 2.40, 2.30}, 3.2, 0.22, 16.0, {1.00, 0.97, 0.92}},
};

}  // namespace bolt::sculpt::room

namespace bolt::sculpt {

using Panorama = assets::RadianceImage;

// Returns the linear RGB radiance that arrives from a unit direction at a point just above the bench.
// Deterministic.
Vec3 workshop_radiance(const Vec3& direction);

// Returns the equirectangular image of workshop_radiance, `width` by `width`/2 pixels.
Panorama workshop_panorama(int width);

}  // namespace bolt::sculpt
