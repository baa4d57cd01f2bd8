// Digits and a few letters as strokes of constant width with round ends, for the sizes and scales on tools.
// No font file is needed. Millimetres.
#pragma once

#include <string_view>
#include <utility>
#include <vector>

#include "game/tool_models/shell.hpp"

namespace bolt::tool_models {

// The points of a stroke in a box of width 0.6 and height 1.
using Stroke = std::vector<std::pair<double, double>>;

// The characters are 0–9, C, N, R, V, m, the full stop, · (as '*') and '-'; any other has no strokes.
std::vector<Stroke> strokes_of(char letter);

double text_width(std::string_view text, double height);  // of a text with this height

// The strokes of a text in the plane z = 0, read along +X with its top towards +Y and its middle at the
// origin.
using PlacedStroke = std::vector<Vec2>;
std::vector<PlacedStroke> text_lines(std::string_view text, double height);

// The same as raised strokes from z0 to z1, each a closed shell of the width `stroke` at its foot.
std::vector<Shell> text_shells(std::string_view text, double height, double stroke, double z0, double z1);

}  // namespace bolt::tool_models
