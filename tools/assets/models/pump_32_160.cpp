// The centrifugal pump (shipped.hpp). CAD frame: the shaft runs along X, the suction flange faces +X, Z is up
// and z = 0 is the axis of the shaft.
#include <fmt/format.h>

#include <BRepAdaptor_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>
#include <gp_Pln.hxx>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/math.hpp"
#include "tools/assets/models/fasteners.hpp"
#include "tools/assets/models/shipped.hpp"
#include "tools/assets/models/solids.hpp"

namespace bolt::models {

// Other models of this target have constants of the same names.
namespace pump {

namespace {

// EN 733, size 32-160, as far as the lesson shows it.
constexpr double axis_height = 132.0, outlet_height = 160.0, suction_face = 80.0;
constexpr double foot_width = 240.0, foot_length = 100.0, foot_pitch_y = 190.0, foot_pitch_x = 70.0;
constexpr double foot_thickness = 16.0, foot_top = -axis_height + foot_thickness;

// The casing ends with the flange that carries the studs; the bearing bracket stands on its face.
constexpr double casing_radius = 98.0, rim_radius = 112.0, rim_front = -22.0, parting = -46.0;
constexpr double bracket_flange = 14.0, stud_circle = 98.0;
constexpr int studs = 8;
constexpr double stud_engagement = 12.5, stud_length = 30.0, stud_hole_depth = 18.0;
constexpr double core_M10 = 8.376, core_M8 = 6.647, core_M12 = 10.106;

constexpr double bearing_radius = 52.0, bearing_front = -120.0, bearing_end = -250.0;
constexpr double cover_thickness = 10.0, cover_circle = 45.0;
constexpr int cover_screws = 4;
constexpr double leg_x = -226.0, leg_half_width = 70.0;
constexpr double plate_top = -axis_height, plate_thickness = 30.0;

// Lays a solid of revolution about Z along the shaft: z becomes x.
TopoDS_Shape about_shaft(const TopoDS_Shape& about_z) {
    gp_Trsf lay;
    lay.SetTransformation(gp_Ax3(gp_Pnt(0.0, 0.0, 0.0), gp::DX(), gp::DY()), gp_Ax3(gp::XOY()));
    return moved(about_z, lay);
}

TopoDS_Shape drill_x(double x0, double x1, double y, double z, double diameter) {
    return cylinder(gp_Ax2(gp_Pnt(x0, y, z), gp::DX()), 0.5 * diameter, x1 - x0);
}
TopoDS_Shape drill_z(double x, double y, double z0, double z1, double diameter) {
    return cylinder(gp_Ax2(gp_Pnt(x, y, z0), gp::DZ()), 0.5 * diameter, z1 - z0);
}

// The place of joint `i` of `count` on a circle about the shaft; joint 0 is half a step past the top.
gp_Pnt on_circle(int i, int count, double radius, double x) {
    const double angle = (i + 0.5) * 2.0 * pi / count;
    return {x, radius * std::sin(angle), radius * std::cos(angle)};
}

// A pipe flange (EN 1092-1, PN16) with its nozzle: face at z = 0, towards +Z.
TopoDS_Shape nozzle(double outside, double circle, double face, double bore, double thickness, double depth) {
    ProfileOutline outline({0.0, 0.0});
    const double neck = bore + 8.0;
    outline.line({face, 0.0})
        .line({face, -2.0})
        .line({outside - 1.0, -2.0})
        .line({outside, -3.0})
        .line({outside, -thickness + 1.0})
        .line({outside - 1.0, -thickness})
        .line({neck + 8.0, -thickness})
        .arc({neck + 8.0 * (1.0 - std::sqrt(0.5)), -thickness - 8.0 * (1.0 - std::sqrt(0.5))},
             {neck, -thickness - 8.0})
        .line({neck + 6.0, -depth})
        .line({0.0, -depth});
    std::vector<TopoDS_Shape> drills;
    for (int i = 0; i < 4; ++i) {
        const double angle = (i + 0.5) * 0.5 * pi;
        drills.push_back(
            drill_z(circle * std::cos(angle), circle * std::sin(angle), -thickness - 1.0, 1.0, 18.0));
    }
    return cut(revolved(outline), drills);
}

// The scroll: rings that grow around the shaft towards the outlet.
std::vector<TopoDS_Shape> scroll() {
    std::vector<TopoDS_Shape> parts;
    ProfileOutline drum({0.0, parting});
    drum.line({rim_radius - 1.0, parting})
        .line({rim_radius, parting + 1.0})
        .line({rim_radius, rim_front - 2.0})
        .line({rim_radius - 2.0, rim_front})
        .line({casing_radius, rim_front})
        .line({casing_radius, 18.0})
        .arc({casing_radius - 12.0 * (1.0 - std::sqrt(0.5)), 18.0 + 12.0 * std::sqrt(0.5)},
             {casing_radius - 12.0, 30.0})
        .line({62.0, 38.0})
        .line({0.0, 38.0});
    parts.push_back(about_shaft(revolved(drum)));
    constexpr int steps = 5;
    for (int i = 0; i < steps; ++i) {
        const double radius = casing_radius + 4.0 - 1.0 * i, off = 2.5 * i;
        ProfileOutline ring({0.0, -20.0});
        ring.line({radius, -20.0}).arc({radius + 10.0 + 1.2 * i, 2.0}, {radius, 24.0}).line({0.0, 24.0});
        parts.push_back(moved(about_shaft(revolved(ring)), shift(0.0, 1.2 * off, 0.9 * off)));
    }
    return parts;
}

TopoDS_Shape foot_hole(double x, double y) {
    return drill_z(x, y, -axis_height - 1.0, foot_top + 40.0, 13.5);
}

TopoDS_Shape casing() {
    std::vector<TopoDS_Shape> parts = scroll();
    // Discharge upwards, suction forwards.
    parts.push_back(
        moved(nozzle(70.0, 50.0, 39.0, 16.0, 18.0, outlet_height - 60.0), shift(0.0, 0.0, outlet_height)));
    parts.push_back(
        moved(about_shaft(nozzle(82.5, 62.5, 51.0, 25.0, 20.0, 50.0)), shift(suction_face, 0.0, 0.0)));
    for (const double side : {-1.0, 1.0}) {
        const double y = side * 0.5 * foot_pitch_y;
        TopoDS_Shape foot = rounded_block(0.0, side * 0.5 * (0.5 * foot_width + 62.0), foot_length,
                                          0.5 * foot_width - 62.0, 10.0, -axis_height, foot_top);
        foot = rounded(foot, 2.0,
                       [](const gp_Pnt& p, const gp_Dir&) { return std::abs(p.Z() - foot_top) < 1e-6; });
        parts.push_back(foot);
        // A web from the foot to the scroll.
        parts.push_back(box(gp_Pnt(-9.0, std::min(side * 50.0, y), -axis_height + 1.0),
                            gp_Pnt(9.0, std::max(side * 50.0, y), -40.0)));
        parts.push_back(box(gp_Pnt(-36.0, side > 0.0 ? 63.0 : -75.0, -axis_height + 1.0),
                            gp_Pnt(18.0, side > 0.0 ? 75.0 : -63.0, -60.0)));
    }
    TopoDS_Shape solid = fused(parts);
    std::vector<TopoDS_Shape> out = {drill_x(20.0, suction_face + 1.0, 0.0, 0.0, 50.0),
                                     drill_z(0.0, 0.0, 70.0, outlet_height + 1.0, 32.0)};
    for (int i = 0; i < studs; ++i) {
        const gp_Pnt at = on_circle(i, studs, stud_circle, parting);
        out.push_back(drill_x(parting - 1.0, parting + stud_hole_depth, at.Y(), at.Z(), core_M10));
    }
    for (const double x : {-0.5 * foot_pitch_x, 0.5 * foot_pitch_x})
        for (const double y : {-0.5 * foot_pitch_y, 0.5 * foot_pitch_y}) out.push_back(foot_hole(x, y));
    return cut(solid, out);
}

// The bearing bracket: flange, lantern, bearing housing and its leg.
TopoDS_Shape bracket() {
    ProfileOutline outline({0.0, parting});
    outline.line({rim_radius - 1.0, parting})
        .line({rim_radius, parting - 1.0})
        .line({rim_radius, parting - bracket_flange + 1.0})
        .line({rim_radius - 1.0, parting - bracket_flange})
        .line({82.0, parting - bracket_flange})
        .arc({76.0, parting - bracket_flange - 4.0}, {72.0, parting - bracket_flange - 12.0})
        .line({bearing_radius + 2.0, bearing_front})
        .line({bearing_radius, bearing_front - 4.0})
        .line({bearing_radius, bearing_end + 26.0})
        .line({bearing_radius + 5.0, bearing_end + 20.0})
        .line({bearing_radius + 5.0, bearing_end + 1.0})
        .line({bearing_radius + 4.0, bearing_end})
        .line({0.0, bearing_end});
    std::vector<TopoDS_Shape> parts = {about_shaft(revolved(outline))};
    TopoDS_Shape sole =
        rounded_block(leg_x, 0.0, 46.0, 2.0 * leg_half_width + 50.0, 10.0, -axis_height, foot_top);
    sole =
        rounded(sole, 2.0, [](const gp_Pnt& p, const gp_Dir&) { return std::abs(p.Z() - foot_top) < 1e-6; });
    parts.push_back(sole);
    parts.push_back(box(gp_Pnt(leg_x - 7.0, -34.0, -axis_height + 1.0), gp_Pnt(leg_x + 7.0, 34.0, -20.0)));
    parts.push_back(box(gp_Pnt(leg_x - 22.0, -7.0, -axis_height + 1.0), gp_Pnt(leg_x + 40.0, 7.0, -30.0)));
    // Cooling ribs along the housing.
    for (int i = 0; i < 12; ++i) {
        const gp_Trsf around = turn(gp::OX(), (i + 0.5) * 2.0 * pi / 12.0);
        parts.push_back(moved(box(gp_Pnt(bearing_end + 24.0, -2.0, 40.0),
                                  gp_Pnt(bearing_front - 2.0, 2.0, bearing_radius + 5.0)),
                              around));
    }
    TopoDS_Shape solid = fused(parts);
    // The lantern is hollow; two windows show the shaft.
    ProfileOutline hollow({0.0, parting - 8.0});
    hollow.line({62.0, parting - 8.0})
        .line({62.0, parting - 22.0})
        .line({44.0, bearing_front + 6.0})
        .line({0.0, bearing_front + 6.0});
    std::vector<TopoDS_Shape> out = {about_shaft(revolved(hollow)),
                                     drill_x(bearing_end - 1.0, bearing_end + 20.0, 0.0, 0.0, 62.0)};
    for (const double side : {-1.0, 1.0})
        out.push_back(box(gp_Pnt(bearing_front + 8.0, std::min(0.0, side * 120.0), -30.0),
                          gp_Pnt(parting - 28.0, std::max(0.0, side * 120.0), 30.0)));
    for (int i = 0; i < studs; ++i) {
        const gp_Pnt at = on_circle(i, studs, stud_circle, parting);
        out.push_back(drill_x(parting - bracket_flange - 1.0, parting + 1.0, at.Y(), at.Z(), 11.0));
    }
    for (int i = 0; i < cover_screws; ++i) {
        const gp_Pnt at = on_circle(i, cover_screws, cover_circle, bearing_end);
        out.push_back(drill_x(bearing_end - 1.0, bearing_end + 20.0, at.Y(), at.Z(), core_M8));
    }
    for (const double y : {-leg_half_width, leg_half_width}) out.push_back(foot_hole(leg_x, y));
    return cut(solid, out);
}

TopoDS_Shape bearing_cover() {
    const double r = bearing_radius + 5.0, end = bearing_end - cover_thickness;
    ProfileOutline outline({17.0, bearing_end});
    outline.line({r, bearing_end})
        .line({r, end + 1.5})
        .line({r - 1.5, end})
        .line({30.0, end})
        .line({26.0, end - 6.0})
        .line({17.0, end - 6.0});
    std::vector<TopoDS_Shape> out;
    for (int i = 0; i < cover_screws; ++i) {
        const gp_Pnt at = on_circle(i, cover_screws, cover_circle, end);
        out.push_back(drill_x(end - 1.0, bearing_end + 1.0, at.Y(), at.Z(), 9.0));
    }
    return cut(about_shaft(revolved(outline)), out);
}

TopoDS_Shape shaft() {
    const double tip = bearing_end - 74.0;
    const TopoDS_Shape bar = about_shaft(revolved({{0.0, parting - 8.5},
                                                   {18.0, parting - 8.5},
                                                   {18.0, bearing_end + 19.0},
                                                   {12.0, bearing_end + 10.0},
                                                   {12.0, tip + 1.5},
                                                   {10.5, tip},
                                                   {0.0, tip}}));
    return cut(bar, box(gp_Pnt(tip + 8.0, -4.0, 8.0), gp_Pnt(tip + 44.0, 4.0, 14.0)));
}

TopoDS_Shape base_plate() {
    TopoDS_Shape plate =
        rounded_block(-110.0, 0.0, 430.0, 290.0, 12.0, plate_top - plate_thickness, plate_top);
    plate = bevelled(plate, 1.5,
                     [](const gp_Pnt& p, const gp_Dir&) { return std::abs(p.Z() - plate_top) < 1e-6; });
    std::vector<TopoDS_Shape> out;
    for (const double x : {-0.5 * foot_pitch_x, 0.5 * foot_pitch_x})
        for (const double y : {-0.5 * foot_pitch_y, 0.5 * foot_pitch_y})
            out.push_back(drill_z(x, y, plate_top - 26.0, plate_top + 1.0, core_M12));
    for (const double y : {-leg_half_width, leg_half_width})
        out.push_back(drill_z(leg_x, y, plate_top - 26.0, plate_top + 1.0, core_M12));
    for (const double x : {-295.0, 75.0})
        for (const double y : {-120.0, 120.0})
            out.push_back(drill_z(x, y, plate_top - plate_thickness - 1.0, plate_top + 1.0, 14.0));
    return cut(plate, out);
}

// Maps +Z to the axis of a joint at a point.
gp_Trsf joint_at(const gp_Pnt& at, const gp_Dir& axis) {
    gp_Trsf placement;
    placement.SetTransformation(gp_Ax3(at, axis, axis.IsParallel(gp::DY(), 1e-6) ? gp::DX() : gp::DY()),
                                gp_Ax3(gp::XOY()));
    return placement;
}

gp_Trsf head_up(double height) { return shift(0.0, 0.0, height) * turn(gp::OX(), pi); }

// The sealing faces of the flanges and the seats of the feet's washers.
std::vector<FaceFinish> machined_faces(const TopoDS_Shape& shape) {
    std::vector<FaceFinish> faces;
    for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
        const BRepAdaptor_Surface surface(TopoDS::Face(at.Current()), false);
        if (surface.GetType() != GeomAbs_Plane) continue;
        const gp_Pnt on = surface.Plane().Location();
        const gp_Dir normal = surface.Plane().Axis().Direction();
        const bool sealing = (normal.IsParallel(gp::DX(), 1e-6) && std::abs(on.X() - suction_face) < 1e-6) ||
                             (normal.IsParallel(gp::DZ(), 1e-6) && std::abs(on.Z() - outlet_height) < 1e-6);
        const bool foot = normal.IsParallel(gp::DZ(), 1e-6) && std::abs(on.Z() - foot_top) < 1e-6;
        if (sealing || foot) faces.push_back({TopoDS::Face(at.Current()), finish::machined_cast_iron});
    }
    return faces;
}

struct Part {
    const char* name;
    const char* part;
    TopoDS_Shape shape;
    Finish finish;
};

}  // namespace

static Status add(CadDocument& document) {
    const Part parts[] = {{"casing", "casing_32_160", casing(), finish::painted_cast_iron},
                          {"bearing_bracket", "bearing_bracket_24", bracket(), finish::painted_cast_iron},
                          {"bearing_cover", "bearing_cover_62", bearing_cover(), finish::machined_cast_iron},
                          {"shaft", "shaft_24", shaft(), finish::machined_steel},
                          {"base_plate", "base_plate", base_plate(), finish::gear_steel}};
    for (const Part& part : parts) {
        const TopoDS_Shape solid = only_solid(part.shape);
        if (solid.IsNull() || !is_valid_solid(solid))
            return fail(ErrorCode::failed,
                        fmt::format("pump-32-160: {} is not one closed, valid solid", part.name),
                        "a solid of which OpenCASCADE reports no fault");
        document.add_instance(document.root(), part.name,
                              document.add_part(part.part, solid, part.finish, machined_faces(solid)));
    }
    const auto group = [&](const std::string& id, const gp_Trsf& placement) {
        return document.add_group(document.root(), "joint_" + id, placement);
    };
    BOLT_TRY_ASSIGN(const auto nut_spec, iso_4032("M10"));
    BOLT_TRY_ASSIGN(const auto washer_spec, iso_7089("M10"));
    BOLT_TRY_ASSIGN(const auto nut_shape, hex_nut(nut_spec));
    BOLT_TRY_ASSIGN(const auto washer_shape, washer(washer_spec));
    BOLT_TRY_ASSIGN(const auto stud_shape, stud({10.0, 1.5, stud_engagement, stud_length, 26.0}));
    const CadPart nut = document.add_part("nut_M10", nut_shape, finish::zinc_plated);
    const CadPart ring = document.add_part("washer_M10", washer_shape, finish::zinc_plated);
    const CadPart rod = document.add_part("stud_M10x30", stud_shape, finish::zinc_plated);
    for (int i = 0; i < studs; ++i) {
        const std::string id = fmt::format("N{}", i + 1);
        const CadGroup joint =
            group(id, joint_at(on_circle(i, studs, stud_circle, parting - bracket_flange), -gp::DX()));
        document.add_instance(joint, id + "_bolt", rod, shift(0.0, 0.0, -bracket_flange));
        document.add_instance(joint, id + "_washer_nut", ring);
        gp_Trsf turned;
        turned.SetRotation(gp::OZ(), nut_phase(bracket_flange + washer_spec.thickness, 1.5));
        document.add_instance(joint, id + "_nut", nut, shift(0.0, 0.0, washer_spec.thickness) * turned);
    }
    BOLT_TRY_ASSIGN(const auto cap_spec, iso_4762("M8", 25.0));
    BOLT_TRY_ASSIGN(const auto cap_shape, socket_screw(cap_spec));
    const CadPart cap = document.add_part("socket_screw_M8x25", cap_shape, finish::black_oxide);
    for (int i = 0; i < cover_screws; ++i) {
        const std::string id = fmt::format("C{}", i + 1);
        const CadGroup joint = group(
            id, joint_at(on_circle(i, cover_screws, cover_circle, bearing_end - cover_thickness), -gp::DX()));
        document.add_instance(joint, id + "_bolt", cap, head_up(0.0));
    }
    BOLT_TRY_ASSIGN(auto screw_spec, iso_4014("M12", 40.0));
    screw_spec.grade = "8.8";
    BOLT_TRY_ASSIGN(const auto screw_shape, hex_bolt(screw_spec));
    BOLT_TRY_ASSIGN(const auto big_washer, washer(*iso_7089("M12")));
    const CadPart screw = document.add_part("screw_M12x40", screw_shape, finish::zinc_plated);
    const CadPart disc = document.add_part("washer_M12", big_washer, finish::zinc_plated);
    const double h = iso_7089("M12")->thickness;
    const std::pair<double, double> feet[] = {{-0.5 * foot_pitch_x, -0.5 * foot_pitch_y},
                                              {0.5 * foot_pitch_x, -0.5 * foot_pitch_y},
                                              {0.5 * foot_pitch_x, 0.5 * foot_pitch_y},
                                              {-0.5 * foot_pitch_x, 0.5 * foot_pitch_y},
                                              {leg_x, leg_half_width},
                                              {leg_x, -leg_half_width}};
    int number = 0;
    for (const auto& [x, y] : feet) {
        const std::string id = fmt::format("F{}", ++number);
        const CadGroup joint = group(id, shift(x, y, foot_top));
        document.add_instance(joint, id + "_washer_head", disc);
        document.add_instance(joint, id + "_bolt", screw, head_up(h));
    }
    return {};
}

}  // namespace pump

Status add_pump_32_160(CadDocument& document) { return pump::add(document); }

}  // namespace bolt::models
