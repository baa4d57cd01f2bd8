// The workshop's measures, shared by its model and its environment picture. Metres; origin: the middle of the
// clamping plate on the bench, y = 0 its upper face, +Z towards the trainee.
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
inline constexpr double dado = 0.12;        // y where the darker paint of the wall ends

// Strip lights under the ceiling, along x.
struct Strip {
    Vec3 centre;
    double length, width;
    double radiance;
    Vec3 colour;
};
inline constexpr std::array<Strip, 2> strips{
    Strip{{-0.25, 1.95, 0.55}, 2.4, 0.16, 26.0, {1.00, 0.97, 0.92}},
    Strip{{0.25, 2.40, 2.30}, 3.2, 0.22, 16.0, {1.00, 0.97, 0.92}},
};

}  // namespace bolt::sculpt::room

// The light of the workshop as a picture in all directions: strip lights, a band of windows on the left, a
// warm wall on the right, a dark floor. Everything is computed from the measures in room.hpp; nothing is
// random.

namespace bolt::sculpt {

using Panorama = assets::RadianceImage;

// Radiance that arrives from a direction at a point a hand above the bench.
Vec3 workshop_radiance(const Vec3& direction);

Panorama workshop_panorama(int width);

}  // namespace bolt::sculpt
