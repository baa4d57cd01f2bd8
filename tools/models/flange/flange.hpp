// A pair of weld-neck flanges DN200 PN16 with a flat gasket, bolted with 12 x M20.
//
// EN 1092-1 type 11, form B1: D 340, K 295, 12 holes 22, C 24, H 62, hub 235 to 219.1 x 6.3, raised face 268
// x 3. Gasket EN 1514-1 form IBC: 220 x 273 x 2. C, H, hub and raised face were not
// checked against a copy of the standard. Pipe stubs and stands are plausible, from no standard.
#pragma once

#include "engine/base/result.hpp"
#include "tools/models/document.hpp"

namespace bolt::models {

// Nuts on the +X side; joints B1 to B12 clockwise as seen from there, B1 first past the top.
Status add_dn200_pn16(Document& document);

}  // namespace bolt::models
