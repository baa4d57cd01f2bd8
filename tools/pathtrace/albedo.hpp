// Directional albedo of the GGX layer, tabulated: the split of E into what scales with F0 and what with F90.
#pragma once

#include <glm/vec2.hpp>

namespace bolt::pathtrace {

// x: ∫ D V (1 − (1 − V·H)⁵) cos, y: ∫ D V (1 − V·H)⁵ cos; E = x + y. A specular layer of F0 and F90 gives
// back F0 x + F90 y of the light in one scattering. `cosine` is N·V, within 0.002 over the whole table.
glm::vec2 directional_albedo(float alpha, float cosine);

// The same by direct integration over `count` directions: what the table is made of.
glm::vec2 integrate_albedo(float alpha, float cosine, unsigned count);

}  // namespace bolt::pathtrace
