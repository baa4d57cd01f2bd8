// The light of the workshop as a picture in all directions: strip lights, a band of windows on the left, a
// warm wall on the right, a dark floor. Everything is computed from the measures in room.hpp; nothing is
// random.
#pragma once

#include "engine/assets/radiance_file.hpp"
#include "engine/base/math.hpp"

namespace bolt::sculpt {

using Panorama = assets::RadianceImage;

// Radiance that arrives from a direction at a point a hand above the bench.
Vec3 workshop_radiance(const Vec3& direction);

Panorama workshop_panorama(int width);

}  // namespace bolt::sculpt
