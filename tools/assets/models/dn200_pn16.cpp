// The pair of flanges DN200 PN16 on stands (shipped.hpp).
#include <fmt/format.h>

#include <cmath>
#include <gp_Ax3.hxx>

#include "engine/base/math.hpp"
#include "tools/assets/models/fasteners.hpp"
#include "tools/assets/models/shipped.hpp"
#include "tools/assets/models/solids.hpp"

namespace bolt::models {

namespace {

// In mm. The letters are those of EN 1092-1.
constexpr double D = 340.0, K = 295.0, L = 22.0, C = 24.0, H = 62.0, N = 235.0, A = 219.1, S = 6.3;
constexpr double hub_end = 16.0;     // length of the straight end of the hub
constexpr double hub_radius = 10.0;  // fillet between plate and hub
constexpr double raised_face = 268.0, raised = 3.0;
constexpr int holes = 12;
constexpr double gasket_inner = 220.0, gasket_outer = 273.0, gasket_thickness = 2.0;
constexpr double pipe_length = 180.0, weld_gap = 2.0;
constexpr double axis_height = 620.0;  // height of the pipe's axis above the floor

gp_Pnt on_bolt_circle(int index, double x) {
    const double angle = (15.0 + 30.0 * index) * pi / 180.0;  // no hole lies on a main axis
    return {x, 0.5 * K * std::sin(angle), 0.5 * K * std::cos(angle)};
}

// About the Z axis: the sealing face points up at z = 0, the pipe end is at z = −H. Holes are numbered as
// seen from the sealing face.
TopoDS_Shape flange() {
    const double bore = 0.5 * A - S, edge = 1.5,
                 land = 1.6;  // land: flat part of the welding end below its 30° bevel
    ProfileOutline outline({bore, 0.0});
    outline.line({0.5 * raised_face - 0.5, 0.0})
        .line({0.5 * raised_face, -0.5})
        .line({0.5 * raised_face, -raised})
        .line({0.5 * D - edge, -raised})
        .line({0.5 * D, -raised - edge})
        .line({0.5 * D, -C + edge})
        .line({0.5 * D - edge, -C});
    // The hub tapers from N at the plate to A. A fillet of hub_radius is tangent to the plate and the taper.
    const double taper = std::atan2(0.5 * (N - A), H - C - hub_end);
    const double reach = hub_radius * std::tan(0.25 * pi - 0.5 * taper);
    const double foot = 0.5 * N;
    const gp_Pnt2d on_plate(foot + reach, -C);
    const gp_Pnt2d on_hub(foot - reach * std::sin(taper), -C - reach * std::cos(taper));
    const gp_Pnt2d centre(on_plate.X(), -C - hub_radius);
    const double half = 0.5 * (0.5 * pi + (pi - taper));  // direction that halves the fillet's arc
    outline.line(on_plate)
        .arc({centre.X() + hub_radius * std::cos(half), centre.Y() + hub_radius * std::sin(half)}, on_hub)
        .line({0.5 * A, -H + hub_end})
        .line({0.5 * A, -H + (S - land) * std::tan(pi / 6.0)})
        .line({bore + land, -H})
        .line({bore, -H});
    TopoDS_Shape body = revolved(outline);
    std::vector<TopoDS_Shape> drills;
    for (int i = 0; i < holes; ++i) {
        const gp_Pnt at = on_bolt_circle(i, 0.0);
        drills.push_back(cylinder(gp_Ax2(gp_Pnt(at.Y(), at.Z(), -C - 1.0), gp::DZ()), 0.5 * L, C + 2.0));
    }
    body = cut(body, drills);
    return bevelled(body, 0.5, [](const gp_Pnt& middle, const gp_Dir& along) {
        const double from_axis = std::hypot(middle.X(), middle.Y());
        const bool rim = std::abs(middle.Z() + C) < 1e-6 || std::abs(middle.Z() + raised) < 1e-6;
        return rim && std::abs(along.Z()) < 1e-6 && std::abs(from_axis - 0.5 * K) < 0.5 * L + 1e-6;
    });
}

TopoDS_Shape ring(double inner, double outer, double z0, double z1) {
    return revolved({{inner, z0}, {outer, z0}, {outer, z1}, {inner, z1}});
}

// The weld seam: a low bead over the bevels, with root and cap.
TopoDS_Shape weld() {
    const double bore = 0.5 * A - S, r = 0.5 * A, half = 5.0;
    ProfileOutline bead({bore + 0.3, -H - 0.5 * weld_gap - 1.5});
    bead.line({bore + 0.3, -H - 0.5 * weld_gap + 1.5})
        .line({r - 0.3, -H - 0.5 * weld_gap + half})
        .arc({r + 1.8, -H - 0.5 * weld_gap}, {r - 0.3, -H - 0.5 * weld_gap - half});
    return revolved(bead);
}

TopoDS_Shape pipe() {
    const double bore = 0.5 * A - S, r = 0.5 * A, land = 1.6, top = -H - weld_gap;
    return revolved({{bore, top},
                     {bore + land, top},
                     {r, top - (S - land) * std::tan(pi / 6.0)},
                     {r, top - pipe_length},
                     {bore, top - pipe_length}});
}

// A stand: foot plate, column and a saddle of 120° for the pipe. It stands under x = 0; the pipe runs along X
// at z = 0.
TopoDS_Shape stand() {
    const double r = 0.5 * A, width = 60.0, floor = -axis_height;
    const TopoDS_Shape foot = bevelled(rounded_block(0.0, 0.0, 200.0, 260.0, 18.0, floor, floor + 15.0), 2.0,
                                       [&](const gp_Pnt& p, const gp_Dir&) { return p.Z() > floor + 14.9; });
    const TopoDS_Shape column =
        cylinder(gp_Ax2(gp_Pnt(0.0, 0.0, floor + 15.0), gp::DZ()), 44.5, axis_height - 150.0);
    const gp_Ax2 across(gp_Pnt(-0.5 * width, 0.0, 0.0), gp::DX());
    TopoDS_Shape saddle = cut(cylinder(across, r + 10.0, width), cylinder(across, r, width));
    saddle = common(
        saddle, box(gp_Pnt(-width, -0.87 * (r + 10.0), -200.0), gp_Pnt(width, 0.87 * (r + 10.0), -0.5 * r)));
    const TopoDS_Shape seat =
        cut(rounded_block(0.0, 0.0, width, 150.0, 10.0, -150.0, -r + 20.0), cylinder(across, r + 5.0, width));
    std::vector<TopoDS_Shape> anchors;
    for (const double x : {-75.0, 75.0})
        for (const double y : {-100.0, 100.0})
            anchors.push_back(cylinder(gp_Ax2(gp_Pnt(x, y, floor - 1.0), gp::DZ()), 7.0, 20.0));
    const TopoDS_Shape head = cylinder(gp_Ax2(gp_Pnt(0.0, 0.0, -162.0), gp::DZ()), 60.0, 12.0);
    std::vector<TopoDS_Shape> parts = {cut(foot, anchors), column, head, seat, saddle};
    for (int i = 0; i < 4; ++i) {  // gussets at the foot of the column
        const gp_Trsf around = turn(gp::OZ(), 0.25 * pi + i * 0.5 * pi);
        const TopoDS_Shape plate = box(gp_Pnt(40.0, -4.0, floor + 10.0), gp_Pnt(85.0, 4.0, floor + 75.0));
        const gp_Ax1 bevel(gp_Pnt(85.0, 0.0, floor + 20.0), gp::DY());
        const TopoDS_Shape corner = moved(
            box(gp_Pnt(85.0, -5.0, floor + 20.0), gp_Pnt(185.0, 5.0, floor + 150.0)), turn(bevel, -0.62));
        parts.push_back(moved(cut(plate, corner), around));
    }
    return fused(parts);
}

// Maps the frame of a flange (about Z, sealing face up) to the pipe along X: towards −X (upstream) or +X.
gp_Trsf to_pipe(bool downstream, double offset) {
    const gp_Dir facing(downstream ? -1.0 : 1.0, 0.0, 0.0);
    gp_Trsf trsf;
    // The flange's x becomes CAD y and its y becomes CAD z. The other side is mirrored in y, which keeps the
    // symmetric holes.
    trsf.SetTransformation(gp_Ax3(gp_Pnt(downstream ? offset : -offset, 0.0, 0.0), facing,
                                  gp_Dir(0.0, downstream ? -1.0 : 1.0, 0.0)),
                           gp_Ax3(gp::XOY()));
    return trsf;
}

}  // namespace

Status add_dn200_pn16(CadDocument& document) {
    const TopoDS_Shape flange_shape = only_solid(flange());
    const TopoDS_Shape stand_shape = only_solid(stand());
    if (flange_shape.IsNull() || stand_shape.IsNull() || !is_valid_solid(flange_shape) ||
        !is_valid_solid(stand_shape))
        return fail(ErrorCode::failed, "dn200-pn16: flange or stand is not one closed, valid solid",
                    "a solid of which OpenCASCADE reports no fault");
    const CadPart flange_part = document.add_part("flange_DN200_PN16", flange_shape, finish::machined_steel);
    const CadPart pipe_part = document.add_part("pipe_219x6", pipe(), finish::galvanised_sheet);
    const CadPart weld_part = document.add_part("weld_seam", weld(), finish::gear_steel);
    const CadPart gasket_part = document.add_part(
        "gasket_DN200_PN16",
        ring(0.5 * gasket_inner, 0.5 * gasket_outer, -0.5 * gasket_thickness, 0.5 * gasket_thickness),
        finish::gasket);
    const CadPart stand_part = document.add_part("stand", stand_shape, finish::painted_cast_iron);

    for (const bool downstream : {false, true}) {
        const char* side = downstream ? "downstream" : "upstream";
        const gp_Trsf placement = to_pipe(downstream, 0.5 * gasket_thickness);
        document.add_instance(document.root(), fmt::format("flange_{}", side), flange_part, placement);
        document.add_instance(document.root(), fmt::format("weld_{}", side), weld_part, placement);
        document.add_instance(document.root(), fmt::format("pipe_{}", side), pipe_part, placement);
        const double x = 0.5 * gasket_thickness + H + weld_gap + 0.6 * pipe_length;
        document.add_instance(document.root(), fmt::format("stand_{}", side), stand_part,
                              shift(downstream ? x : -x, 0.0, 0.0));
    }
    document.add_instance(document.root(), "gasket", gasket_part, to_pipe(false, 0.0));

    BOLT_TRY_ASSIGN(const auto fasteners,
                    add_fasteners(document, "M20", 80.0, finish::zinc_plated, nullptr, "8.8"));
    for (int i = 0; i < holes; ++i) {
        gp_Trsf placement;
        const gp_Pnt at = on_bolt_circle(i, 0.5 * gasket_thickness + C);
        const gp_Dir outward(0.0, at.Y(), at.Z());
        placement.SetTransformation(gp_Ax3(at, gp::DX(), outward), gp_Ax3(gp::XOY()));
        add_joint(document, document.root(), fmt::format("B{}", i + 1), fasteners, 2.0 * C + gasket_thickness,
                  placement);
    }
    return {};
}

}  // namespace bolt::models
