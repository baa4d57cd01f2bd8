// Digits and a few letters as strokes of constant width with round ends, for the sizes and scales that are
// stamped into metal. No font file is needed.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string_view>
#include <vector>

namespace bolt::models {

// The text in the plane z = 0, read along +X with its top towards +Y and its middle at the origin. Each
// stroke is a solid from z0 to z1. The characters are 0–9, C, N, R, V, m, · (as '*') and '-'; any other
// leaves a gap. Millimetres.
std::vector<TopoDS_Shape> text_strokes(std::string_view text, double height, double stroke, double z0,
                                       double z1);

double text_width(std::string_view text, double height);

}  // namespace bolt::models
