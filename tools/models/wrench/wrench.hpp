// Open-end wrenches in the look of forged tools. Proportions follow what such tools have, no standard.
// Frame: origin in the middle of the jaw at mid thickness, +X along the handle, +Z normal to the flat; the
// mouth opens at −X turned by 15° about z. Millimetres.
#pragma once

#include "engine/base/result.hpp"
#include "tools/models/document.hpp"

namespace bolt::models {

struct WrenchSpec {
    double size = 0.0;        // across flats of the nut
    double jaw = 0.0;         // opening
    double grip = 0.0;        // from the jaw's middle to the middle of the grip
    double head_angle = 0.0;  // rad
    double head_width = 0.0;
    double head_thickness = 0.0;
    double handle_thickness = 0.0;
    double handle_width = 0.0;  // at its narrowest
    double end = 0.0;           // x of the far end
};

WrenchSpec wrench_spec(double size, double grip);

Result<TopoDS_Shape> open_end_wrench(const WrenchSpec& spec);

Status add_wrench(Document& document, double size, double grip);

}  // namespace bolt::models
