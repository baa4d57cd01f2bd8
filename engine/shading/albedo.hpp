// The directional albedo of a GGX layer as a table, split into the parts that scale with F0 and F90.
#pragma once

#include <glm/vec2.hpp>

namespace bolt::shading {

// x: ∫ D V (1 − (1 − V·H)⁵) cos, y: ∫ D V (1 − V·H)⁵ cos; E = x + y. In single scattering, a specular layer
// reflects the fraction F0 x + F90 y. `cosine` is N·V. Accurate within 0.002 over the whole table.
glm::vec2 directional_albedo(float alpha, float cosine);

// The same by numerical integration over `count` directions; used to build the table.
glm::vec2 integrate_albedo(float alpha, float cosine, unsigned count);

}  // namespace bolt::shading
