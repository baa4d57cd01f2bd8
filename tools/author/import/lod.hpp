// The far level: meshes simplified by one common error until the whole assembly fits its budget.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/assets/model.hpp"

namespace bolt::step_import {

struct FarLevel {
    std::vector<assets::Mesh> meshes;  // as given, simplified
    std::size_t triangles = 0;         // counting uses
    double error = 0.0;                // m, that simplifying has added
};

// `uses`: how often each mesh is placed. Both sides of a hard edge, and of where two materials
// meet, move together, so that no gap opens. The error stops at `most_error` (m) even where the budget is not
// met.
FarLevel simplify(const std::vector<assets::Mesh>& meshes, const std::vector<std::size_t>& uses,
                  std::size_t budget, double most_error);

}  // namespace bolt::step_import
