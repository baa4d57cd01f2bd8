#include "tools/assets/models/reducer/gear.hpp"

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <GeomConvert.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierCurve.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColStd_HArray1OfReal.hxx>
#include <TColgp_Array2OfPnt.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <array>
#include <cmath>
#include <cstddef>
#include <gp_Circ.hxx>
#include <gp_Pln.hxx>
#include <numbers>

#include "tools/assets/models/reducer/drive.hpp"
#include "tools/assets/models/reducer/shapes.hpp"

namespace bolt::models::reducer {
namespace {

Point2 turned(Point2 p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y};
}

// The rounded tip of the rack-shaped tool, relative to the gear's reference circle and the gap's middle.
struct ToolTip {
    double rounding = 0.0;
    double depth = 0.0;    // of the rounding's centre below the rolling line
    double lateral = 0.0;  // of the rounding's centre from the middle of the tool's tooth
};

ToolTip tool_tip(const GearSpec& gear, const GearCircles& c) {
    const double m = gear.module_mm;
    const double alpha = c.transverse_pressure_angle;
    ToolTip tip;
    tip.rounding = tool_rounding * m;
    tip.depth = (dedendum - tool_rounding - gear.shift) * m;
    tip.lateral = std::numbers::pi * c.transverse_module_mm / 4.0 -
                  (dedendum - tool_rounding) * m * std::tan(alpha) - tip.rounding / std::cos(alpha) +
                  gear.thinning_mm / 2.0;
    return tip;
}

// The point of the fillet that the tool's rounding generates when the rack has moved by `roll`, and the
// profile's tangent there.
void fillet_point(const ToolTip& tip, double r, double roll, Point2& point, Point2& tangent) {
    const Point2 arm{-tip.depth, tip.lateral + roll};  // from the rolling point to the rounding's centre
    const double length = std::hypot(arm.x, arm.y);
    const Point2 normal{arm.x / length, arm.y / length};
    const Point2 at{r + arm.x + tip.rounding * normal.x, arm.y + tip.rounding * normal.y};
    point = turned(at, -roll / r);
    tangent = turned({normal.y, -normal.x}, -roll / r);
}

// The arc length of the fillet between two positions of the rack. The chords are so short that their sum is
// exact to a nanometre.
double fillet_length(const ToolTip& tip, double r, double from, double to) {
    constexpr int steps = 2000;
    double length = 0.0;
    Point2 before, point, tangent;
    fillet_point(tip, r, from, before, tangent);
    for (int i = 1; i <= steps; ++i, before = point) {
        fillet_point(tip, r, from + (to - from) * i / steps, point, tangent);
        length += std::hypot(point.x - before.x, point.y - before.y);
    }
    return length;
}

}  // namespace

GearCircles circles(const GearSpec& gear) {
    const double m = gear.module_mm;
    GearCircles c;
    c.transverse_module_mm = m / std::cos(gear.helix);
    c.transverse_pressure_angle = std::atan(std::tan(pressure_angle) / std::cos(gear.helix));
    c.reference_mm = gear.teeth * c.transverse_module_mm;
    c.base_mm = c.reference_mm * std::cos(c.transverse_pressure_angle);
    c.tip_mm = c.reference_mm + 2.0 * m * (addendum + gear.shift);
    c.root_mm = c.reference_mm - 2.0 * m * (dedendum - gear.shift);
    return c;
}

double min_shift(const GearSpec& gear) {
    const double s = std::sin(circles(gear).transverse_pressure_angle);
    return addendum - gear.teeth * s * s / (2.0 * std::cos(gear.helix));
}

double involute(double angle) { return std::tan(angle) - angle; }

double half_tooth_angle(const GearSpec& gear, double radius_mm) {
    const GearCircles c = circles(gear);
    const double thickness =
        c.transverse_module_mm * (std::numbers::pi / 2.0 + 2.0 * gear.shift * std::tan(pressure_angle)) -
        gear.thinning_mm;
    return thickness / c.reference_mm + involute(c.transverse_pressure_angle) -
           involute(std::acos(std::min(1.0, c.base_mm / (2.0 * radius_mm))));
}

double twist(const GearSpec& gear, double distance_mm) {
    const double sense = gear.hand == HelixHand::right ? 1.0 : -1.0;
    return sense * distance_mm * std::tan(gear.helix) / (circles(gear).reference_mm / 2.0);
}

FlankProfile flank_profile(const GearSpec& gear, int fillet_points, int flank_points) {
    const GearCircles c = circles(gear);
    const ToolTip tip = tool_tip(gear, c);
    const double r = c.reference_mm / 2.0, base = c.base_mm / 2.0;
    FlankProfile profile;

    // Even steps of the normal's direction follow the curvature of the fillet.
    const double end_angle = std::numbers::pi / 2.0 - c.transverse_pressure_angle;
    for (int i = 0; i < fillet_points; ++i) {
        const double roll = tip.depth * std::tan(end_angle * i / (fillet_points - 1)) - tip.lateral;
        Point2 point, tangent;
        fillet_point(tip, r, roll, point, tangent);
        profile.fillet.push_back(point);
        profile.fillet_lengths.push_back(fillet_length(tip, r, -tip.lateral, roll));
        if (i == 0) profile.fillet_start_tangent = tangent;
        if (i == fillet_points - 1) profile.fillet_end_tangent = tangent;
    }

    // Even steps of the roll angle tan(alpha): in that parameter the involute is closest to a polynomial.
    const Point2 join = profile.fillet.back();
    const double first = std::sqrt(std::max(0.0, (join.x * join.x + join.y * join.y) / (base * base) - 1.0));
    const double last = std::sqrt(c.tip_mm * c.tip_mm / (c.base_mm * c.base_mm) - 1.0);
    for (int i = 0; i < flank_points; ++i) {
        const double roll = first + (last - first) * i / (flank_points - 1);
        const double radius = base * std::sqrt(1.0 + roll * roll);
        const double angle = std::numbers::pi / gear.teeth - half_tooth_angle(gear, radius);
        profile.flank_lengths.push_back(base * (roll * roll - first * first) / 2.0);
        profile.flank.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        if (i == flank_points - 1) {
            // The angle between the involute and the radius is the pressure angle, here atan(roll).
            const double direction = angle + std::atan(roll);
            profile.flank_end_tangent = {std::cos(direction), std::sin(direction)};
        }
    }
    return profile;
}

namespace {

// With these numbers of points the interpolation is within 3e-4 mm of the profile. A pinion needs more: its
// flank begins near the base circle, where the involute's curvature is largest. Every point costs a row of
// poles per tooth in the file.
constexpr int fillet_points = 5, wheel_flank_points = 5, pinion_flank_points = 9;

using SplineCurve = Handle(Geom_BSplineCurve);

// A spline through the points. Its parameter is the arc length, so that the unit tangents at the ends apply.
SplineCurve interpolated(const std::vector<Point2>& points, const std::vector<double>& lengths, Point2 first,
                         Point2 last) {
    const int n = static_cast<int>(points.size());
    Handle(TColgp_HArray1OfPnt) array = new TColgp_HArray1OfPnt(1, n);
    Handle(TColStd_HArray1OfReal) parameters = new TColStd_HArray1OfReal(1, n);
    for (std::size_t i = 0; i < points.size(); ++i) {
        array->SetValue(static_cast<int>(i) + 1, gp_Pnt(points[i].x, points[i].y, 0.0));
        parameters->SetValue(static_cast<int>(i) + 1, lengths[i]);
    }
    GeomAPI_Interpolate maker(array, parameters, false, 1e-9);
    maker.Load(gp_Vec(first.x, first.y, 0.0), gp_Vec(last.x, last.y, 0.0), false);
    maker.Perform();
    if (!maker.IsDone()) throw BuildError{"tooth profile: the interpolation failed"};
    return maker.Curve();
}

// A short arc about the origin as one cubic. Over one tooth its error is far below a nanometre.
SplineCurve arc(double radius, double from, double to) {
    const double k = 4.0 / 3.0 * std::tan((to - from) / 4.0);
    TColgp_Array1OfPnt poles(1, 4);
    const auto at = [&](double angle, double along) {
        return gp_Pnt(radius * (std::cos(angle) - along * std::sin(angle)),
                      radius * (std::sin(angle) + along * std::cos(angle)), 0.0);
    };
    poles(1) = at(from, 0.0), poles(2) = at(from, k), poles(3) = at(to, -k), poles(4) = at(to, 0.0);
    return GeomConvert::CurveToBSplineCurve(new Geom_BezierCurve(poles));
}

SplineCurve mirrored(const SplineCurve& curve) {
    SplineCurve copy = Handle(Geom_BSplineCurve)::DownCast(curve->Copy());
    copy->Mirror(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(1, 0, 0)));
    copy->Reverse();
    return copy;
}

// The outline of one gap and the next tooth tip, counter-clockwise.
std::vector<SplineCurve> pitch_outline(const GearSpec& gear) {
    const FlankProfile p =
        flank_profile(gear, fillet_points, gear.teeth < 30 ? pinion_flank_points : wheel_flank_points);
    const SplineCurve fillet =
        interpolated(p.fillet, p.fillet_lengths, p.fillet_start_tangent, p.fillet_end_tangent);
    const SplineCurve flank =
        interpolated(p.flank, p.flank_lengths, p.fillet_end_tangent, p.flank_end_tangent);
    const Point2 root = p.fillet.front(), tip = p.flank.back();
    const double root_angle = std::atan2(root.y, root.x), tip_angle = std::atan2(tip.y, tip.x);
    return {mirrored(flank),
            mirrored(fillet),
            arc(std::hypot(root.x, root.y), -root_angle, root_angle),
            fillet,
            flank,
            arc(std::hypot(tip.x, tip.y), tip_angle, 2.0 * std::numbers::pi / gear.teeth - tip_angle)};
}

// The screw motion over the face width as a cubic: it maps a pole of the section to its four poles along the
// width.
struct ScrewMotion {
    std::array<double, 4> c{}, s{}, z{};
};

ScrewMotion screw(const GearSpec& gear, double turn) {
    const double half = gear.width_mm / 2.0;
    const double a = turn + twist(gear, -half), b = turn + twist(gear, half);
    const double k = 4.0 / 3.0 * std::tan((b - a) / 4.0);
    ScrewMotion m;
    m.c = {std::cos(a), std::cos(a) - k * std::sin(a), std::cos(b) + k * std::sin(b), std::cos(b)};
    m.s = {std::sin(a), std::sin(a) + k * std::cos(a), std::sin(b) - k * std::cos(b), std::sin(b)};
    // A cubic arc does not rotate evenly. The inner poles are placed so that width and rotation also agree at
    // both quarters.
    const double h = (b - a) / 2.0, kc = std::cos(h) + k * std::sin(h), ks = std::sin(h) - k * std::cos(h);
    const double quarter =
        std::atan2(-0.40625 * std::sin(h) - 0.28125 * ks, 0.4375 * std::cos(h) + 0.5625 * kc) / h;
    const double inner = half * (-quarter - 0.40625) / 0.28125;
    m.z = {-half, -inner, inner, half};
    return m;
}

gp_Pnt screwed_pole(const ScrewMotion& m, const gp_Pnt& p, std::size_t j) {
    return {m.c[j] * p.X() - m.s[j] * p.Y(), m.s[j] * p.X() + m.c[j] * p.Y(), m.z[j]};
}

Handle(Geom_BSplineSurface) swept(const SplineCurve& section, const ScrewMotion& m) {
    const int n = section->NbPoles();
    TColgp_Array2OfPnt poles(1, n, 1, 4);
    for (int i = 1; i <= n; ++i)
        for (std::size_t j = 0; j < 4; ++j)
            poles(i, static_cast<int>(j) + 1) = screwed_pole(m, section->Pole(i), j);
    TColStd_Array1OfReal v_knots(1, 2);
    TColStd_Array1OfInteger v_multiplicities(1, 2);
    v_knots(1) = 0.0, v_knots(2) = 1.0;
    v_multiplicities.Init(4);
    return new Geom_BSplineSurface(poles, section->Knots(), v_knots, section->Multiplicities(),
                                   v_multiplicities, section->Degree(), 3);
}

TopoDS_Edge end_edge(const SplineCurve& section, const ScrewMotion& m, std::size_t j) {
    SplineCurve curve = Handle(Geom_BSplineCurve)::DownCast(section->Copy());
    for (int i = 1; i <= curve->NbPoles(); ++i) curve->SetPole(i, screwed_pole(m, section->Pole(i), j));
    return BRepBuilderAPI_MakeEdge(curve).Edge();
}

TopoDS_Face end_face(const TopoDS_Wire& outline, double z, double hole) {
    BRepBuilderAPI_MakeFace face(gp_Pln(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), outline, true);
    if (hole > 0.0) {
        const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, z), gp_Dir(0, 0, 1)), hole);
        face.Add(TopoDS::Wire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle)).Wire().Reversed()));
    }
    return face.Face();
}

}  // namespace

TopoDS_Shape gear_solid(const GearSpec& gear, const std::vector<std::pair<double, double>>& inside) {
    BRepBuilderAPI_Sewing sewing(1e-4);
    BRepBuilderAPI_MakeWire lower, upper;
    const std::vector<SplineCurve> outline = pitch_outline(gear);
    for (int i = 0; i < gear.teeth; ++i) {
        const ScrewMotion m = screw(gear, 2.0 * std::numbers::pi * i / gear.teeth);
        for (const SplineCurve& section : outline) {
            sewing.Add(BRepBuilderAPI_MakeFace(swept(section, m), 1e-6).Face());
            lower.Add(end_edge(section, m, 0));
            upper.Add(end_edge(section, m, 3));
        }
    }
    const double half = gear.width_mm / 2.0, hole = inside.empty() ? 0.0 : inside.front().first;
    sewing.Add(end_face(upper.Wire(), half, hole));
    sewing.Add(end_face(lower.Wire(), -half, hole));
    if (!inside.empty()) {
        BRepBuilderAPI_MakePolygon profile;
        for (const auto& [radius, z] : inside) profile.Add(gp_Pnt(radius, 0.0, z));
        sewing.Add(BRepPrimAPI_MakeRevol(profile.Wire(), gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1))).Shape());
    }
    sewing.Perform();
    if (sewing.NbFreeEdges() != 0 || sewing.SewedShape().ShapeType() != TopAbs_SHELL)
        throw BuildError{"gear: the faces do not close"};
    TopoDS_Shape solid = BRepBuilderAPI_MakeSolid(TopoDS::Shell(sewing.SewedShape())).Solid();
    if (volume(solid) < 0.0) solid.Reverse();
    return one_solid("gear", solid);
}

}  // namespace bolt::models::reducer
