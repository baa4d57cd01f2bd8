// The models that Boltwright ships. Each function adds one model to a document; a part that cannot be built
// as one closed, valid solid is an error.
#pragma once

#include "engine/base/result.hpp"
#include "tools/assets/models/document.hpp"

namespace bolt::models {

// The two-stage helical gear reducer ZQ350 with its twelve joints. Its dimensions are in reducer/layout.hpp.
Status add_zq350(CadDocument& document);

// The base frame of this reducer with the washers and the eight bolts M20 of its feet, in the same frame.
Status add_zq350_base(CadDocument& document);

// A pair of weld-neck flanges DN200 PN16 with a flat gasket and 12 bolts M20.
//
// EN 1092-1 type 11, form B1: D 340, K 295, 12 holes 22, C 24, H 62, hub 235 to 219.1 x 6.3, raised face 268
// x 3. Gasket EN 1514-1 form IBC: 220 x 273 x 2. C, H, hub and raised face were not checked against a copy of
// the standard. Pipe stubs and stands are plausible and follow no standard.
//
// The nuts are on the +X side. Seen from there, joints B1 to B12 run clockwise, with B1 first past the top.
Status add_dn200_pn16(CadDocument& document);

// A small housing with a cover on four bolts M8: the template for a new assembly. All dimensions are
// invented. The cover's upper face, under the nuts, lies at CAD z = 10 mm; the bolts stand at (±50, ±40) mm.
Status add_cover_m8(CadDocument& document);

// A centrifugal pump with an end-suction casing on a base plate: 8 studs M10 with nuts hold the bearing
// bracket, 4 cap screws M8 the bearing cover, and 6 hexagon screws M12 the feet. Heights, feet and nozzles
// are those of EN 733, size 32-160, from memory; everything else is plausible and follows no standard.
Status add_pump_32_160(CadDocument& document);

// An open-end wrench for a nut of `size` mm across flats, with `grip` mm from the middle of the jaw to the
// middle of the grip (wrench.hpp describes its frame).
Status add_wrench(CadDocument& document, double size, double grip);

// A click torque wrench with an open-end insert, 40 to 200 N·m. Its proportions are plausible and follow no
// standard. Its frame is that of the other wrenches, but the head is not turned: the mouth opens towards −X.
Status add_torque_wrench(CadDocument& document, double size);

}  // namespace bolt::models
