// The light of the workshop as a picture in all directions: strip lights, a band of windows on the left, a
// warm wall on the right, a dark floor. Everything is computed from the measures in room.hpp; nothing is
// random.
#pragma once

#include <glm/vec3.hpp>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::sculpt {

// Equirectangular, rows from the top (+Y). The middle column looks to −Z, the columns right of it to +X.
struct Panorama {
    int width = 0, height = 0;
    std::vector<glm::vec3> pixels;
};

// Radiance that arrives from a direction at a point a hand above the bench.
Vec3 workshop_radiance(const Vec3& direction);

Panorama workshop_panorama(int width);

}  // namespace bolt::sculpt
