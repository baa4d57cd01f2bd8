#include "tools/assets/models/reducer/casing.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Cylinder.hxx>
#include <gp_Pln.hxx>
#include <numbers>

#include "tools/assets/models/reducer/fittings.hpp"

namespace bolt::models::reducer {
namespace {

// A rib from the crest of a bearing boss up to the wall.
TopoDS_Shape upper_rib(const ShaftLayout& shaft) {
    const double r = shaft.boss_radius;
    return rib(shaft.x, 11.0,
               {{80.0, r - 12.0}, {143.0, r - 12.0}, {143.0, r + 9.0}, {99.5, r + 36.0}, {80.0, r + 36.0}});
}

// A block with rounded corners on the seat of the inspection cover.
TopoDS_Shape hatch_block(double length, double width, double corner, double z0, double z1) {
    const gp_Ax2 frame(gp_Pnt(0, 0, z0), gp_Dir(0, 0, 1), gp_Dir(1, 0, 0));
    return moved(extruded(rounded_rectangle(frame, length, width, corner), gp_Vec(0, 0, z1 - z0)),
                 hatch_frame());
}

struct LiftingEye {
    double x, z, root_x, root_z;
};
constexpr std::array<LiftingEye, 2> eyes{{{-44.0, 128.0, -30.0, 84.0}, {512.0, 138.0, 462.0, 92.0}}};

// A rib from the underside of a bearing boss down to the foot. Without a foot it ends in the wall.
TopoDS_Shape lower_rib(const ShaftLayout& shaft, bool to_foot) {
    const double r = shaft.boss_radius + casting_overhang;
    if (to_foot)
        return rib(shaft.x, 13.0,
                   {{80.0, r - 12.0},
                    {144.0, r - 12.0},
                    {144.0, r + 10.0},
                    {152.0, -sole_z - 10.0},
                    {80.0, -sole_z - 10.0}});
    return rib(shaft.x, 13.0,
               {{80.0, r - 12.0}, {144.0, r - 12.0}, {144.0, r + 4.0}, {98.0, 185.0}, {80.0, 185.0}});
}

TopoDS_Shape foot(double x) {
    const double top = -sole_z - foot_thickness;
    const gp_Ax2 frame(gp_Pnt(x, (foot_inner + foot_outer) / 2.0, top), gp_Dir(0, 0, 1));
    const TopoDS_Shape plate =
        extruded(rounded_rectangle(frame, 2.0 * foot_half_length, foot_outer - foot_inner, 16.0),
                 gp_Vec(0, 0, foot_thickness));
    return filleted("foot", plate, 3.0, [&](const TopoDS_Edge& edge) { return in_plane_z(edge, top); });
}

constexpr double hook_x = 19.0,
                 hook_z = 71.0;  // distances of the rope's seat from the wall and the parting plane

// A lifting hook under the end flange; its rope seat is cut later. `out` is the sign of x away from the
// casing's middle. It is built upside down, as the whole lower half is.
TopoDS_Shape hook(double wall_x, double out) {
    const auto at = [&](double x, double z) { return gp_Pnt(wall_x + out * x, -10.0, z); };
    return lug(polygon({at(-14, 14), at(42, 14), at(42, 64), at(30, 76), at(-14, 106)}));
}

TopoDS_Shape boss_in(const gp_Trsf& frame, double radius, double depth) {
    return moved(cylinder_z(0, 0, -depth, 0, radius), frame);
}

}  // namespace

Result<Casting> casing_upper() {
    return catch_build_errors("upper casing", [] {
        const TopoDS_Shape outside = housing(contour_upper, 0.0, half_width, 14.0);
        TopoDS_Shape half = side_bosses(
            blended("upper flange", common(outside, half_space_y()), flange_half(0.0), 6.0, on_rim), 0.0);
        for (const ShaftLayout& shaft : shafts) half = blended("upper rib", half, upper_rib(shaft), 3.0);
        TopoDS_Shape whole = merged_faces(fused({half, mirrored_y(half)}));
        whole = blended("cover seat", whole, hatch_block(hatch.length, hatch.width, hatch.corner, -14.0, 0.0),
                        4.0);
        Shapes tools = machining(true);
        for (const LiftingEye& eye : eyes) {
            whole = blended("lifting eye", whole,
                            lug(hull_y(-10.0, eye.x, eye.z, 25.0, eye.root_x, eye.root_z, 34.0)), 5.0);
            tools.push_back(cylinder_y(eye.x, eye.z, -20.0, 20.0, 14.0));
        }
        tools.push_back(hatch_block(hatch.opening_length, hatch.opening_width, 12.0, -40.0, 1.0));
        for (const double x : {-hatch.screw_x, 0.0, hatch.screw_x})
            for (const double y : {-hatch.screw_y, hatch.screw_y})
                tools.push_back(moved(cylinder_z(x, y, -20.0, 1.0, 4.02), hatch_frame()));
        tools.push_back(housing(contour_upper, wall, half_width - wall, 0.0));
        TopoDS_Shape shape = common(cut(whole, tools), half_space_z(true));
        shape = one_solid("upper casing", merged_faces(shape));
        return Casting{shape, machined_faces(shape)};
    });
}

// The lower half is built upside down, from the same shapes as the upper half, and turned over before its
// holes are cut.
Result<Casting> casing_lower() {
    return catch_build_errors("lower casing", [] {
        const TopoDS_Shape outside = housing(contour_lower, 0.0, half_width, 10.0);
        TopoDS_Shape half = side_bosses(blended("lower flange", common(outside, half_space_y()),
                                                flange_half(casting_overhang), 6.0, on_rim),
                                        casting_overhang);
        for (const double x : feet) half = blended("foot", half, foot(x), 4.0);
        for (const ShaftLayout& shaft : shafts) {
            bool to_foot = false;
            for (const double x : feet) to_foot |= x == shaft.x;
            half = blended("lower rib", half, lower_rib(shaft, to_foot), 3.0);
        }
        TopoDS_Shape whole = merged_faces(fused({half, mirrored_y(half)}));
        whole = blended("lifting hook", whole, hook(wall_left, -1.0), 4.0);
        whole = blended("lifting hook", whole, hook(wall_right, 1.0), 4.0);
        whole = mirrored_z(whole);
        whole = blended("sight glass boss", whole, boss_in(glass_frame(), glass_boss, 12.0), 3.0);
        whole = blended("drain boss", whole, boss_in(drain_frame(), 17.0, 20.0), 3.0);
        Shapes tools = machining(false);
        tools.push_back(mirrored_z(housing(contour_lower, wall, half_width - wall, 7.0)));
        for (const double x : feet)
            for (const double dx : {-foot_hole_offset, foot_hole_offset})
                for (const double y : {-foot_hole_y, foot_hole_y}) {
                    tools.push_back(cylinder_z(x + dx, y, sole_z - 10.0, sole_z + 40.0, foot_hole / 2.0));
                    const double top = sole_z + foot_thickness;
                    tools.push_back(cylinder_z(x + dx, y, top - foot_spot_depth, top + 6.0, 19.0));
                }
        for (const double x : {wall_left - hook_x, wall_right + hook_x})
            tools.push_back(cylinder_y(x, -hook_z, -20.0, 20.0, 12.0));
        tools.push_back(boss_in(glass_frame(), 18.05, 30.0));
        tools.push_back(boss_in(drain_frame(), 8.05, 50.0));
        TopoDS_Shape shape = common(cut(whole, tools), half_space_z(false));
        shape = one_solid("lower casing", merged_faces(shape));
        return Casting{shape, machined_faces(shape)};
    });
}

namespace {

constexpr double far = 2000.0;
// Heights as cast, before the spot faces are cut.
constexpr double cast_flange = flange_thickness + spot_depth, cast_boss = boss_height + spot_depth;
constexpr double cap_screw_depth = 24.0;
constexpr double cap_screw_hole = 4.02;  // radius; the screw's thread is modelled as its outside cylinder
constexpr double dowel_hole = 5.65;

TopoDS_Wire housing_outline(std::span<const ContourCircle> contour, double y, double inset) {
    const auto on = [&](const ContourCircle& c, double angle) {
        return gp_Pnt(c.x + (c.r - inset) * std::cos(angle), y, c.z + (c.r - inset) * std::sin(angle));
    };
    BRepBuilderAPI_MakeWire wire;
    const auto line = [&](const gp_Pnt& a, const gp_Pnt& b) { wire.Add(BRepBuilderAPI_MakeEdge(a, b)); };
    const auto below = [&](const gp_Pnt& p, double side) {
        return gp_Pnt(p.X() + side * (p.Z() + overlap) * std::tan(draft), y, -overlap);
    };
    double from = std::numbers::pi - draft;
    const gp_Pnt first = on(contour.front(), from), last = on(contour.back(), draft);
    line(below(first, -1.0), first);
    for (std::size_t i = 0; i < contour.size(); ++i) {
        const ContourCircle& c = contour[i];
        double to = draft;
        if (i + 1 < contour.size()) {  // normal of the common tangent to this circle and the next, from above
            const double dx = contour[i + 1].x - c.x, dz = contour[i + 1].z - c.z;
            to = std::atan2(dz, dx) + std::acos((c.r - contour[i + 1].r) / std::hypot(dx, dz));
        }
        wire.Add(BRepBuilderAPI_MakeEdge(
            GC_MakeArcOfCircle(on(c, from), on(c, (from + to) / 2.0), on(c, to)).Value()));
        if (i + 1 < contour.size()) line(on(c, to), on(contour[i + 1], to));
        from = to;
    }
    line(last, below(last, 1.0));
    line(below(last, 1.0), below(first, -1.0));
    return wire.Wire();
}

}  // namespace

TopoDS_Shape half_space_y() { return box({-far, far, 0.0, far, -far, far}); }

TopoDS_Shape half_space_z(bool upper) {
    return upper ? box({-far, far, -far, far, 0.0, far}) : box({-far, far, -far, far, -far, 0.0});
}

TopoDS_Shape housing(std::span<const ContourCircle> contour, double inset, double half, double radius) {
    const double low = half + overlap * std::tan(draft), high = half - 300.0 * std::tan(draft);
    const TopoDS_Shape block =
        extruded(housing_outline(contour, -half - 5.0, inset), gp_Vec(0, 2.0 * half + 10.0, 0));
    const TopoDS_Shape wedge = extruded(polygon({gp_Pnt(-500, -low, -overlap), gp_Pnt(-500, low, -overlap),
                                                 gp_Pnt(-500, high, 300), gp_Pnt(-500, -high, 300)}),
                                        gp_Vec(1500, 0, 0));
    const TopoDS_Shape solid = common(block, wedge);
    if (radius == 0.0) return solid;
    return filleted("housing", solid, radius, [&](const TopoDS_Edge& edge) {
        return std::abs(middle(edge).Y()) > 50.0 && !in_plane_z(edge, -overlap);
    });
}

bool on_rim(const TopoDS_Edge& edge) {
    return in_plane_z(edge, -overlap) || std::abs(middle(edge).Y()) < 1e-3;
}

TopoDS_Shape flange_half(double grown) {
    const gp_Ax2 frame(gp_Pnt((flange_left + flange_right) / 2.0, 0.0, -overlap), gp_Dir(0, 0, 1));
    const TopoDS_Wire outline = rounded_rectangle(frame, flange_right - flange_left + 2.0 * grown,
                                                  2.0 * (flange_half_width + grown), flange_corner + grown);
    const TopoDS_Shape plate = extruded(outline, gp_Vec(0, 0, cast_flange + overlap));
    const TopoDS_Shape rounded =
        filleted("flange", plate, 3.0, [](const TopoDS_Edge& edge) { return in_plane_z(edge, cast_flange); });
    return common(rounded, half_space_y());
}

TopoDS_Shape bearing_boss(const ShaftLayout& shaft, double grown) {
    const double r = shaft.boss_radius + grown, y = seat_inner - 3.0, length = seat_outer - y;
    BRepBuilderAPI_MakeWire wire;
    const gp_Pnt a(shaft.x + r, y, -overlap), b(shaft.x + r, y, 0), top(shaft.x, y, r), c(shaft.x - r, y, 0),
        d(shaft.x - r, y, -overlap);
    wire.Add(BRepBuilderAPI_MakeEdge(a, b));
    wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(b, top, c).Value()));
    wire.Add(BRepBuilderAPI_MakeEdge(c, d));
    wire.Add(BRepBuilderAPI_MakeEdge(d, a));
    const TopoDS_Shape boss = extruded(wire.Wire(), gp_Vec(0, length, 0));
    return chamfered("bearing boss", boss, 1.5, [](const TopoDS_Edge& edge) {
        const gp_Pnt p = middle(edge);
        return p.Y() > seat_outer - 1e-3 && p.Z() > -overlap + 1e-3;
    });
}

TopoDS_Shape bolt_boss(const JointLayout& joint, double grown) {
    // A cone that narrows towards the top by the draft, with straight sides back into the wall.
    const double top = boss_radius + grown, base = top + (cast_boss + overlap) * std::tan(draft);
    const TopoDS_Shape cone =
        BRepPrimAPI_MakeCone(gp_Ax2(gp_Pnt(joint.x, joint.y, -overlap), gp_Dir(0, 0, 1)), base, top,
                             cast_boss + overlap)
            .Shape();
    const double back = half_width - 12.0;
    const gp_Pnt p0(joint.x - base, back, -overlap), p1(joint.x + base, back, -overlap),
        p2(joint.x + top, back, cast_boss), p3(joint.x - top, back, cast_boss);
    const TopoDS_Shape sides = extruded(polygon({p0, p1, p2, p3}), gp_Vec(0, joint.y - back, 0));
    const TopoDS_Shape boss = merged_faces(fused({cone, sides}));
    return filleted("bolt boss", boss, 3.0, [&](const TopoDS_Edge& edge) {
        return in_plane_z(edge, cast_boss) && middle(edge).Y() > back + 1e-3;
    });
}

TopoDS_Shape side_bosses(const TopoDS_Shape& body, double grown) {
    // Bolt bosses and bearing bosses intersect where OpenCASCADE cannot build a rounding. Therefore each kind
    // is blended onto the bare body, and the two results are joined.
    TopoDS_Shape bearings = body, bolts = body;
    for (const ShaftLayout& shaft : shafts)
        bearings = blended("bearing boss", bearings, bearing_boss(shaft, grown), 5.0, on_rim);
    for (const JointLayout& joint : joints)
        if (joint.at_bearing && joint.y > 0.0)
            bolts = blended("bolt boss", bolts, bolt_boss(joint, grown), 4.0, on_rim);
    return fused({bearings, bolts});
}

TopoDS_Shape rib(double x, double thickness, const std::vector<std::pair<double, double>>& outline) {
    std::vector<gp_Pnt> points;
    for (const auto& [y, z] : outline) points.emplace_back(x - thickness / 2.0, y, z);
    const TopoDS_Shape plate = extruded(polygon(points), gp_Vec(thickness, 0, 0));
    const double y0 = half_width, side = thickness / 2.0;
    return filleted("rib", plate, 0.4 * thickness, [&](const TopoDS_Edge& edge) {
        const gp_Pnt p = middle(edge);
        return p.Y() > y0 && std::abs(std::abs(p.X() - x) - side) < 1e-6;
    });
}

TopoDS_Shape lug(const TopoDS_Wire& outline_at_minus_10) {
    const TopoDS_Shape plate = extruded(outline_at_minus_10, gp_Vec(0, 20, 0));
    return filleted("lifting lug", plate, 4.0, [](const TopoDS_Edge& edge) {
        return std::abs(std::abs(middle(edge).Y()) - 10.0) < 1e-6;
    });
}

Shapes machining(bool upper) {
    const double side = upper ? 1.0 : -1.0;
    Shapes tools;
    for (const ShaftLayout& shaft : shafts) {
        tools.push_back(
            cylinder_y(shaft.x, 0.0, -seat_outer - 10.0, seat_outer + 10.0, shaft.bearing_outer / 2.0));
        const CapSpec cap = cap_spec(shaft, 0.0, 0.0, 0.0);
        for (int i = 0; i < cap.screws; ++i) {
            const double angle = cap_screw_angle(cap, i), dx = cap.screw_circle * std::cos(angle),
                         z = cap.screw_circle * std::sin(angle);
            if (z * side < 0.0) continue;
            for (const double y : {-seat_outer - 1.0, seat_outer - cap_screw_depth})
                tools.push_back(cylinder_y(shaft.x + dx, z, y, y + cap_screw_depth + 1.0, cap_screw_hole));
        }
    }
    for (const auto& [x, y] : dowels) tools.push_back(cylinder_z(x, y, -40.0, 40.0, dowel_hole));
    for (const JointLayout& joint : joints) {
        tools.push_back(cylinder_z(joint.x, joint.y, -100.0, 100.0, bolt_hole / 2.0));
        const double seat = thickness(joint);
        const double z0 = side > 0 ? seat : -seat - 20.0;
        tools.push_back(cylinder_z(joint.x, joint.y, z0, z0 + 20.0, spot_face / 2.0));
    }
    return tools;
}

std::vector<FaceFinish> machined_faces(const TopoDS_Shape& shape) {
    const auto near = [](double a, double b) { return std::abs(a - b) < 1e-3; };
    std::vector<gp_Pln> planes = {gp_Pln(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)),
                                  gp_Pln(gp_Pnt(0, 0, sole_z), gp_Dir(0, 0, 1)),
                                  gp_Pln(gp_Pnt(0, seat_outer, 0), gp_Dir(0, 1, 0)),
                                  gp_Pln(gp_Pnt(0, -seat_outer, 0), gp_Dir(0, 1, 0))};
    for (const gp_Trsf& frame : {hatch_frame(), glass_frame(), drain_frame()})
        planes.emplace_back(gp_Pnt(0, 0, 0).Transformed(frame), gp_Dir(0, 0, 1).Transformed(frame));
    const auto machined = [&](const TopoDS_Face& face) {
        const BRepAdaptor_Surface surface(face);
        if (surface.GetType() == GeomAbs_Plane) {
            const gp_Pnt p = surface.Plane().Location();
            const gp_Dir n = surface.Plane().Axis().Direction();
            for (const gp_Pln& plane : planes)
                if (plane.Axis().Direction().IsParallel(n, 1e-6) && plane.Distance(p) < 1e-3) return true;
            // Spot faces are cut deeper than the cast face, so their height identifies them.
            const double height = std::abs(p.Z());
            return near(std::abs(n.Z()), 1.0) &&
                   (near(height, boss_height) || near(height, flange_thickness) ||
                    near(p.Z(), sole_z + foot_thickness - foot_spot_depth));
        }
        if (surface.GetType() != GeomAbs_Cylinder) return false;
        const gp_Cylinder c = surface.Cylinder();
        for (const ShaftLayout& shaft : shafts)
            if (near(c.Radius(), shaft.bearing_outer / 2.0) &&
                near(std::abs(c.Axis().Direction().Y()), 1.0) && near(c.Location().X(), shaft.x))
                return true;
        return near(c.Radius(), bolt_hole / 2.0) || near(c.Radius(), foot_hole / 2.0) ||
               near(c.Radius(), dowel_hole);
    };
    std::vector<FaceFinish> faces;
    TopTools_IndexedMapOfShape map;
    TopExp::MapShapes(shape, TopAbs_FACE, map);
    for (int i = 1; i <= map.Extent(); ++i)
        if (machined(TopoDS::Face(map(i))))
            faces.push_back({TopoDS::Face(map(i)), finish::machined_cast_iron});
    return faces;
}

}  // namespace bolt::models::reducer
