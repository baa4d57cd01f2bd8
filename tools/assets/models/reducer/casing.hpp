// The two halves of the cast casing.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "tools/assets/models/document.hpp"

namespace bolt::models::reducer {

struct Casting {
    TopoDS_Shape shape;
    std::vector<FaceFinish> machined;  // faces cut by a tool, which carry no paint
};

Result<Casting> casing_upper();
Result<Casting> casing_lower();

}  // namespace bolt::models::reducer
