// A helical gear as a solid: involute flanks, rack-cut fillets, all within 3e-4 mm.
#pragma once

#include <TopoDS_Shape.hxx>
#include <utility>
#include <vector>

#include "tools/models/reducer/gear.hpp"

namespace bolt::models::reducer {

// Axis +Z, mid plane z = 0, the middle of a gap on +X. `inside` is the outline (radius, z) of what lies
// within the rim, from the upper end face to the lower; without it the end faces are full discs.
TopoDS_Shape gear_solid(const GearSpec& gear, const std::vector<std::pair<double, double>>& inside = {});

}  // namespace bolt::models::reducer
