// The round body under a thread's height field, as a closed solid with exact cylinders and cones and ruled
// flanks.
#pragma once

#include <TopoDS_Shape.hxx>

#include "engine/base/result.hpp"
#include "tools/models/thread_field.hpp"

namespace bolt::models {

// Around the Z axis from z0 to z1, closed with flat ends. Neighbouring faces share their edges.
Result<TopoDS_Shape> threaded_rod(const ThreadField& field);

}  // namespace bolt::models
