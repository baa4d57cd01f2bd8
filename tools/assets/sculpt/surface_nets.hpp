// The zero surface of a field as triangles: naive surface nets (S. F. Gibson, MERL TR99-24), each vertex then
// brought onto the surface and spread evenly along it.
#pragma once

#include "tools/assets/sculpt/field.hpp"
#include "tools/assets/sculpt/mesh.hpp"

namespace bolt::sculpt {

struct Box {
    Vec3 low, high;
};

// The surface must lie inside the box and the field must not fall faster than twice the distance: blocks of
// cells are passed over on the word of their centre.
TriMesh extract(const Field& field, const Box& box, double cell, int relaxations = 3);

}  // namespace bolt::sculpt
