#include "tools/assets/models/reducer/fittings.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <cmath>
#include <gp_Ax3.hxx>
#include <gp_Circ.hxx>
#include <numbers>

#include "tools/assets/models/glyphs.hpp"
#include "tools/assets/models/reducer/casing.hpp"
#include "tools/assets/models/reducer/shapes.hpp"

namespace bolt::models::reducer {
namespace {

constexpr double plate_thickness = 1.6;

const gp_Ax2 upright(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0));

gp_Trsf frame(const gp_Pnt& at, const gp_Dir& z, const gp_Dir& x) {
    gp_Trsf placement;
    placement.SetTransformation(gp_Ax3(at, z, x), gp_Ax3());
    return placement;
}

TopoDS_Shape hexagon(double across_flats, double z0, double z1) {
    std::vector<gp_Pnt> points;
    for (int i = 0; i < 6; ++i) {
        const double angle = i * std::numbers::pi / 3.0, r = across_flats / std::sqrt(3.0);
        points.emplace_back(r * std::cos(angle), r * std::sin(angle), z0);
    }
    const TopoDS_Shape prism = extruded(polygon(points), gp_Vec(0, 0, z1 - z0));
    // The chamfer of 30 degrees of a hexagon head.
    const double r = across_flats / std::sqrt(3.0), flat = 0.95 * across_flats / 2.0;
    return common(
        prism,
        revolved(upright,
                 {{0, z0}, {r + 1.0, z0}, {r + 1.0, z1 - (r + 1.0 - flat) * 0.577}, {flat, z1}, {0, z1}}));
}

TopoDS_Shape plate(double length, double width, double corner, double z0, double z1) {
    const gp_Ax2 at(gp_Pnt(0, 0, z0), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0));
    return extruded(rounded_rectangle(at, length, width, corner), gp_Vec(0, 0, z1 - z0));
}

Shapes hatch_holes(double radius, double z0, double z1) {
    Shapes holes;
    for (const double x : {-hatch.screw_x, 0.0, hatch.screw_x})
        for (const double y : {-hatch.screw_y, hatch.screw_y})
            holes.push_back(cylinder_z(x, y, z0, z1, radius));
    return holes;
}

}  // namespace

CapSpec cap_spec(const ShaftLayout& shaft, double through_shaft, double seal_outer, double seal_width) {
    CapSpec cap;
    cap.seat = shaft.bearing_outer / 2.0;
    cap.flange = shaft.boss_radius - 2.0;
    cap.thickness = 12.0;
    cap.spigot = seat_outer - (bearing_inner + shaft.bearing_width);
    cap.screws = shaft.cap_screws;
    cap.screw_circle = cap.seat + 9.5;
    cap.shaft = through_shaft / 2.0;
    cap.seal_outer = seal_outer / 2.0;
    cap.seal_width = seal_width;
    return cap;
}

double cap_screw_angle(const CapSpec& cap, int i) {
    return std::numbers::pi / cap.screws +
           i * 2.0 * std::numbers::pi / cap.screws;  // none in the parting plane
}

gp_Trsf cap_frame(const ShaftLayout& shaft, bool front) {
    const double side = front ? -1.0 : 1.0;
    return frame(gp_Pnt(shaft.x, side * seat_outer, 0.0), gp_Dir(0, side, 0), gp_Dir(1, 0, 0));
}

Result<TopoDS_Shape> end_cap(const CapSpec& cap) {
    return catch_build_errors("end cap", [&] {
        const double t = cap.thickness, f = cap.flange, s = cap.seat;
        std::vector<std::pair<double, double>> outline;
        if (cap.shaft > 0.0) {
            const double floor = t - cap.seal_width - 1.0, bore = cap.shaft + 1.0, rim = cap.seal_outer + 7.0;
            outline = {{bore, floor},
                       {cap.seal_outer, floor},
                       {cap.seal_outer, t + 2.0},
                       {rim, t + 2.0},
                       {rim + 2.0, t - 1.0},
                       {f - 2.5, t - 1.0},
                       {f, t - 3.5},
                       {f, 0},
                       {s, 0},
                       {s, 1.0 - cap.spigot},
                       {s - 1.0, -cap.spigot},
                       {s - 8.0, -cap.spigot},
                       {s - 10.0, floor - 9.0},
                       {bore, floor - 9.0}};
        } else {
            const double dish = s - 6.0;
            outline = {{0, t - 5.0},
                       {dish - 6.0, t - 5.0},
                       {dish - 1.0, t - 1.0},
                       {f - 2.5, t - 1.0},
                       {f, t - 3.5},
                       {f, 0},
                       {s, 0},
                       {s, 1.0 - cap.spigot},
                       {s - 1.0, -cap.spigot},
                       {s - 8.0, -cap.spigot},
                       {s - 10.0, -4.0},
                       {0, -4.0}};
        }
        Shapes holes;
        for (int i = 0; i < cap.screws; ++i) {
            const double a = cap_screw_angle(cap, i);
            holes.push_back(cylinder_z(cap.screw_circle * std::cos(a), cap.screw_circle * std::sin(a), -1.0,
                                       t + 1.0, 4.5));
        }
        return one_solid("end cap", cut(revolved(upright, outline), holes));
    });
}

Result<TopoDS_Shape> lip_seal(const CapSpec& cap) {
    return catch_build_errors("lip seal", [&] {
        const double z0 = cap.thickness - cap.seal_width - 1.0, z1 = z0 + cap.seal_width,
                     lip = cap.shaft + 0.05;
        return one_solid("lip seal", revolved(upright, {{cap.seal_outer, z0},
                                                        {cap.seal_outer, z1 - 0.5},
                                                        {cap.seal_outer - 0.5, z1},
                                                        {lip + 3.0, z1},
                                                        {lip + 2.5, z1 - 1.5},
                                                        {lip + 0.6, z1 - 2.2},
                                                        {lip, z1 - 3.0},
                                                        {lip + 1.5, z0}}));
    });
}

gp_Trsf hatch_frame() {
    const ContourCircle &a = contour_upper[1], &b = contour_upper[2];
    const double lean = std::asin((b.r - a.r) / (b.x - a.x));  // of the common tangent from above
    const gp_Dir normal(-std::sin(lean), 0, std::cos(lean)), along(std::cos(lean), 0, std::sin(lean));
    const gp_Vec to_tangent = gp_Vec(normal) * ((a.r + b.r) / 2.0 + hatch.pad);
    return frame(gp_Pnt((a.x + b.x) / 2.0, 0, 0).Translated(to_tangent), normal, along);
}

Result<TopoDS_Shape> hatch_gasket() {
    return catch_build_errors("cover gasket", [] {
        Shapes holes = hatch_holes(4.5, -1.0, 5.0);
        holes.push_back(plate(hatch.opening_length, hatch.opening_width, 12.0, -1.0, 5.0));
        return one_solid("cover gasket",
                         cut(plate(hatch.length, hatch.width, hatch.corner, 0.0, hatch.gasket), holes));
    });
}

Result<TopoDS_Shape> hatch_cover() {
    return catch_build_errors("inspection cover", [] {
        const double z0 = hatch.gasket, z1 = hatch.gasket + hatch.cover;
        TopoDS_Shape cover =
            filleted("inspection cover", plate(hatch.length, hatch.width, hatch.corner, z0, z1), 1.5,
                     [&](const TopoDS_Edge& edge) { return in_plane_z(edge, z1); });
        Shapes holes = hatch_holes(4.5, 0.0, 20.0);
        holes.push_back(cylinder_z(0, 0, 0.0, 20.0, 10.0));
        return one_solid("inspection cover", cut(cover, holes));
    });
}

Result<TopoDS_Shape> breather() {
    return catch_build_errors("breather", [] {
        const TopoDS_Shape stem =
            revolved(upright, {{0, -12}, {9, -12}, {10, -11}, {10, 2}, {9, 2}, {9, 16}, {0, 16}});
        const TopoDS_Shape cap = revolved(
            upright, {{0, 14}, {17, 14}, {17.5, 14.5}, {17.5, 24}, {17, 26}, {14, 29}, {8, 30.5}, {0, 31}});
        Shapes slots;
        for (int i = 0; i < 8; ++i) {
            gp_Trsf turn;
            turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), i * std::numbers::pi / 4.0);
            slots.push_back(moved(box({13.0, 20.0, -1.5, 1.5, 17.0, 23.0}), turn));
        }
        return one_solid("breather", cut(fused({stem, hexagon(27.0, 0.0, 10.0), cap}), slots));
    });
}

gp_Trsf glass_frame() {
    const double y = -(half_width + oil_z * std::tan(draft));
    const gp_Dir out(0, -std::cos(draft), -std::sin(draft));
    return frame(gp_Pnt(glass_x, y, oil_z).Translated(gp_Vec(out) * boss_face), out, gp_Dir(1, 0, 0));
}

Result<TopoDS_Shape> glass_bezel() {
    return catch_build_errors("sight glass bezel", [] {
        const TopoDS_Shape ring =
            revolved(upright, {{15, -8}, {18, -8}, {18, 0}, {25, 0}, {25, 4.5}, {23.5, 6}, {17, 6}, {15, 4}});
        Shapes notches;
        for (int i = 0; i < 4; ++i) {
            const double a = std::numbers::pi / 4.0 + i * std::numbers::pi / 2.0;
            notches.push_back(cylinder_z(21.0 * std::cos(a), 21.0 * std::sin(a), 4.0, 10.0, 1.8));
        }
        return one_solid("sight glass bezel", cut(ring, notches));
    });
}

Result<TopoDS_Shape> glass_disc() {
    return catch_build_errors("sight glass",
                              [] { return one_solid("sight glass", cylinder_z(0, 0, -4.0, 3.0, 15.0)); });
}

gp_Trsf drain_frame() {
    const ContourCircle& corner = contour_lower[1];
    const double x = corner.x + corner.r;
    return frame(gp_Pnt(x + boss_face, 0, -corner.z + 8.0), gp_Dir(1, 0, 0), gp_Dir(0, 1, 0));
}

Result<TopoDS_Shape> drain_plug() {
    return catch_build_errors("drain plug", [] {
        const TopoDS_Shape body =
            revolved(upright, {{0, -16}, {7, -16}, {8, -15}, {8, 2}, {13, 2}, {13, 4.5}, {0, 4.5}});
        return one_solid("drain plug", fused({body, hexagon(17.0, 4.0, 12.0)}));
    });
}

Result<TopoDS_Shape> drain_ring() {
    return catch_build_errors("drain plug ring", [] {
        return one_solid("ring", revolved(upright, {{8.2, 0}, {12.5, 0}, {12.5, 2}, {8.2, 2}}));
    });
}

gp_Trsf nameplate_frame() {
    const double z = 128.0, y = -(half_width - z * std::tan(draft));
    return frame(gp_Pnt(258.0, y, z), gp_Dir(0, -std::cos(draft), std::sin(draft)), gp_Dir(1, 0, 0));
}

Result<TopoDS_Shape> nameplate() {
    return catch_build_errors("nameplate", [] {
        const TopoDS_Shape body =
            chamfered("nameplate", plate(96.0, 50.0, 4.0, 0.0, plate_thickness), 0.4,
                      [](const TopoDS_Edge& edge) { return in_plane_z(edge, plate_thickness); });
        Shapes parts{body};  // the loops add four rivets
        for (const double x : {-43.0, 43.0})
            for (const double y : {-20.0, 20.0})
                parts.push_back(revolved(gp_Ax2(gp_Pnt(x, y, 0), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0)),
                                         {{0, 1.0}, {2.2, 1.0}, {2.2, 2.0}, {1.2, 2.8}, {0, 2.8}}));
        return one_solid("nameplate", fused(parts));
    });
}

Result<TopoDS_Shape> nameplate_text() {
    return catch_build_errors("nameplate text", [] {
        const double z0 = plate_thickness, z1 = plate_thickness + 0.4, stroke = 2.4;
        // A stroke with square ends around the line from a to b.
        const auto bar = [&](double xa, double ya, double xb, double yb) {
            const double dx = xb - xa, dy = yb - ya, l = std::hypot(dx, dy), u = dx / l * stroke / 2.0,
                         v = dy / l * stroke / 2.0;
            return extruded(polygon({gp_Pnt(xa - u + v, ya - v - u, z0), gp_Pnt(xb + u + v, yb + v - u, z0),
                                     gp_Pnt(xb + u - v, yb + v + u, z0), gp_Pnt(xa - u - v, ya - v + u, z0)}),
                            gp_Vec(0, 0, z1 - z0));
        };
        // glyphs.hpp has no Z and no Q, so they are drawn here.
        const double top = 17.0, low = 3.0;
        const TopoDS_Shape ring =
            cut(plate(11.0, top - low + stroke, 5.4, z0, z1),
                {plate(11.0 - 2.0 * stroke, top - low - stroke, 3.0, z0 - 1.0, z1 + 1.0)});
        gp_Trsf to_q;
        to_q.SetTranslation(gp_Vec(-12.0, (top + low) / 2.0, 0.0));
        const TopoDS_Shape z =
            fused({bar(-33.0, top, -24.0, top), bar(-24.0, top, -33.0, low), bar(-33.0, low, -24.0, low)});
        const TopoDS_Shape q = fused({moved(ring, to_q), bar(-11.5, 6.5, -6.5, 2.0)});
        Shapes parts{z, q};
        gp_Trsf to_number;
        to_number.SetTranslation(gp_Vec(17.0, (top + low) / 2.0, 0.0));
        for (const TopoDS_Shape& shape : text_strokes("350", top - low + stroke, stroke, z0, z1))
            parts.push_back(moved(shape, to_number));
        // Below the name: the lines of an empty table, as on real nameplates.
        for (const double y : {-3.0, -10.0, -17.0})
            parts.push_back(box({-36.0, 36.0, y - 0.4, y + 0.4, z0, z1}));
        for (const double x : {-12.0, 12.0}) parts.push_back(box({x - 0.4, x + 0.4, -16.6, -3.4, z0, z1}));
        return fused(parts);
    });
}

Result<TopoDS_Shape> oil_surface() {
    return catch_build_errors("oil surface", [] {
        // A slice of the sump, 0.3 mm smaller all round.
        const TopoDS_Shape sump =
            mirrored_z(housing(contour_lower, wall + 0.3, half_width - wall - 0.3, 7.0));
        const TopoDS_Shape film = common(sump, box({-500.0, 1000.0, -500.0, 500.0, oil_z - 0.5, oil_z}));
        // The wheels dip into the oil; a gap of 1 mm stays open around them.
        const double r1 = circles(wheel_1).tip_mm / 2.0 + 1.0, r2 = circles(wheel_2).tip_mm / 2.0 + 1.0;
        const double b1 = wheel_1.width_mm / 2.0 + 1.0, b2 = wheel_2.width_mm / 2.0 + 1.0;
        return one_solid("oil surface",
                         cut(film, {cylinder_y(shafts[1].x, 0, pair_1_y - b1, pair_1_y + b1, r1),
                                    cylinder_y(shafts[2].x, 0, pair_2_y - b2, pair_2_y + b2, r2)}));
    });
}

Result<TopoDS_Shape> dowel() {
    // Taper pin 1:50 (ISO 2339) without the thread at its thick end.
    return catch_build_errors("dowel", [] {
        return TopoDS_Shape(
            BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(0, 0, -30), gp_Dir(0, 0, 1)), 5.0, 5.6, 60.0).Shape());
    });
}

}  // namespace bolt::models::reducer
