// Digits and a few letters as strokes of even width with round ends: sizes and scales stamped into metal. No
// font file.
#pragma once

#include <TopoDS_Shape.hxx>
#include <string_view>
#include <vector>

namespace bolt::models {

// The text in the plane z = 0, read along +X with its top towards +Y, its middle at the origin; each stroke a
// solid from z0 to z1. Knows 0–9, C, N, R, V, m, · (as '*'), '.' and '-'; other characters leave a gap.
// Millimetres.
std::vector<TopoDS_Shape> text_strokes(std::string_view text, double height, double stroke, double z0,
                                       double z1);

double text_width(std::string_view text, double height);

}  // namespace bolt::models
