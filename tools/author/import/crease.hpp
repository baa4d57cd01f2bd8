// Normals made from triangles alone, for meshes that no longer lie on their surface.
#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace bolt::step_import {

// A normal for every corner (as many as indices): the mean, weighted by area, of the triangles around the
// corner's place that turn by less than `crease` (rad) against its own. Large flats stay flat, edges stay
// hard.
std::vector<glm::vec3> crease_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<std::uint32_t>& indices, double crease);

}  // namespace bolt::step_import
