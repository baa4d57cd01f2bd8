// Splits triangles inside a face until they keep the deflection: the mesher keeps it along edges, but may
// miss it by half inside a sphere or a fillet. The sides on the face's rim stay, so that neighbours still
// fit.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tools/author/import/face_surface.hpp"

namespace bolt::step_import {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

// Appends corners to `surface` and `corners` (positions, m) and replaces triangles.
void refine(FaceSurface& surface, std::vector<Vec3>& corners, Triangles& triangles, double deflection);

// Largest distance (m) of the triangles from their surface, looked at in the middle of sides and triangles.
double deviation(const FaceSurface& surface, const std::vector<Vec3>& corners, const Triangles& triangles);

}  // namespace bolt::step_import
