// The parts that are fastened to the casing: end caps, seals, inspection cover, breather, sight glass, drain
// plug, nameplate, dowels.
#pragma once

#include <TopoDS_Shape.hxx>
#include <gp_Trsf.hxx>

#include "engine/base/result.hpp"
#include "tools/assets/models/document.hpp"
#include "tools/assets/models/reducer/layout.hpp"

namespace bolt::models::reducer {

// A bearing cap. Local +Z points out of the casing; z = 0 is the machined face of the casing. A cap that the
// shaft passes through holds a lip seal.
struct CapSpec {
    double seat = 0.0, flange = 0.0;       // radii
    double thickness = 0.0, spigot = 0.0;  // lengths along z
    int screws = 0;
    double screw_circle = 0.0;             // radius
    double shaft = 0.0, seal_outer = 0.0;  // radii; 0 for a blind cap
    double seal_width = 0.0;               // along z; 0 for a blind cap
};

CapSpec cap_spec(const ShaftLayout& shaft, double through_shaft, double seal_outer, double seal_width);
// The angle, rad about the cap's +Z, at which screw `i` lies.
double cap_screw_angle(const CapSpec& cap, int i);
// Each ..._frame() function returns the placement of a part's local frame in the reducer.
gp_Trsf cap_frame(const ShaftLayout& shaft, bool front);  // `front`: on the -Y side

Result<TopoDS_Shape> end_cap(const CapSpec& cap);
Result<TopoDS_Shape> lip_seal(const CapSpec& cap);

// The inspection cover on the slope between the two wheels. Local +Z points out of the casing.
struct HatchSpec {
    double length = 152.0, width = 124.0, corner = 16.0;  // of pad, gasket and cover
    double opening_length = 104.0, opening_width = 76.0;  // in the casing
    double screw_x = 64.0, screw_y = 50.0;                // distances from the middle
    double pad = 6.0, gasket = 1.5, cover = 8.0;          // thicknesses
};
inline constexpr HatchSpec hatch;
gp_Trsf hatch_frame();  // its origin on the pad's machined face
Result<TopoDS_Shape> hatch_gasket();
Result<TopoDS_Shape> hatch_cover();
Result<TopoDS_Shape> breather();  // z = 0 is the cover's outer face

// The oil sight glass is on the -Y side, the drain plug in the wall at the output end. +Z points out of the
// casing. glass_x: position of the glass; glass_boss: radius of its boss; boss_face: height of both bosses
// above the wall.
inline constexpr double glass_x = 478.0, glass_boss = 29.0, boss_face = 5.0;
gp_Trsf glass_frame();
gp_Trsf drain_frame();
Result<TopoDS_Shape> glass_bezel();
Result<TopoDS_Shape> glass_disc();
Result<TopoDS_Shape> drain_plug();
Result<TopoDS_Shape> drain_ring();

gp_Trsf nameplate_frame();
Result<TopoDS_Shape> nameplate();
Result<TopoDS_Shape> nameplate_text();

Result<TopoDS_Shape> oil_surface();
Result<TopoDS_Shape> dowel();

}  // namespace bolt::models::reducer
