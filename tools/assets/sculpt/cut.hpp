// Cutting a mesh along the zero line of a value at its vertices, so that the border between two materials is
// a smooth curve and not a saw.
#pragma once

#include <functional>

#include "tools/assets/sculpt/mesh.hpp"

namespace bolt::sculpt {

// Afterwards no triangle has the line inside. Vertices close to the line move onto it instead of leaving
// slivers.
void cut(TriMesh& mesh, const std::function<double(const Vec3&)>& value);

}  // namespace bolt::sculpt
