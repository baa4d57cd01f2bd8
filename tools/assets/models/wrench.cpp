#include "tools/assets/models/wrench.hpp"

#include <fmt/format.h>

#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <GeomAPI_Interpolate.hxx>
#include <Geom_BSplineCurve.hxx>
#include <TColgp_HArray1OfPnt.hxx>
#include <cmath>

#include "engine/base/math.hpp"
#include "tools/assets/models/glyphs.hpp"
#include "tools/assets/models/shipped.hpp"
#include "tools/assets/models/solids.hpp"

namespace bolt::models {

namespace {

struct HeadDimensions {
    double radius, middle;  // of the disc; its middle (x) lies a little behind the jaw
    double tip;             // x of the tips of the jaw
    double throat;          // x of the bottom of the jaw
    double half;            // half of the jaw's opening
};

HeadDimensions head_of(const WrenchSpec& s) {
    return {0.5 * s.head_width, 0.05 * s.size, -0.7 * s.size, 0.6 * s.size, 0.5 * s.jaw};
}

}  // namespace

TopoDS_Shape forged_head(const WrenchSpec& s) {
    const HeadDimensions h = head_of(s);
    const double high = s.head_thickness, R = h.radius;
    const TopoDS_Shape disc =
        cut(cylinder(gp_Ax2(gp_Pnt(h.middle, 0.0, -high), gp::DZ()), R, 2.0 * high),
            box(gp_Pnt(-3.0 * R, -2.0 * R, -2.0 * high), gp_Pnt(h.tip, 2.0 * R, 2.0 * high)));
    return rounded(disc, 0.22 * s.size, [&](const gp_Pnt& p, const gp_Dir& along) {
        return upright(along) && std::abs(p.X() - h.tip) < 1e-6;
    });
}

TopoDS_Shape with_jaw(const TopoDS_Shape& forging, const WrenchSpec& s) {
    const HeadDimensions h = head_of(s);
    const double high = s.head_thickness;
    const gp_Trsf to_head = turn(gp::OZ(), s.head_angle), from_head = to_head.Inverted();
    // Parallel flats and a rounded throat that clears the corners of the hexagon, enlarged by `wider` all
    // round.
    const auto slot = [&](double wider, double z0, double z1) {
        const double end = h.throat + wider;
        const TopoDS_Shape block =
            box(gp_Pnt(-4.0 * h.radius, -h.half - wider, z0), gp_Pnt(end, h.half + wider, z1));
        return rounded(block, 0.29 * s.size + wider, [&](const gp_Pnt& p, const gp_Dir& along) {
            return upright(along) && std::abs(p.X() - end) < 1e-6;
        });
    };
    TopoDS_Shape body = cut(forging, moved(slot(0.0, -high, high), to_head));
    body = rounded(body, 0.06 * s.size, [&](const gp_Pnt& p, const gp_Dir& along) {  // lead-in at the tips
        const gp_Pnt q = p.Transformed(from_head);
        return upright(along) && std::abs(q.X() - h.tip) < 1e-3 && std::abs(std::abs(q.Y()) - h.half) < 1e-3;
    });
    // Chamfer the edges of the jaw: cut a shallow, wider slot, whose walls lean by 45°, into both faces.
    const double c = 0.025 * s.size, deep = 2.0 * c, floor = 0.5 * s.head_thickness - deep;
    const TopoDS_Shape lean = bevelled(slot(c, floor, high), deep, [&](const gp_Pnt& p, const gp_Dir& along) {
        return !upright(along) && std::abs(p.Z() - floor) < 1e-6 && p.X() > -3.9 * h.radius;
    });
    const TopoDS_Shape below = moved(lean, turn(gp::OX(), pi));
    return cut(body, {moved(lean, to_head), moved(below, to_head)});
}

std::vector<TopoDS_Shape> size_stamps(const WrenchSpec& s) {
    const HeadDimensions h = head_of(s);
    const gp_Trsf to_head = turn(gp::OZ(), s.head_angle);
    const gp_Trsf placement =
        to_head * shift(0.5 * (h.throat + h.middle + h.radius), 0.0, 0.0) * turn(gp::OZ(), -0.5 * pi);
    const gp_Trsf below = to_head * turn(gp::OX(), pi) * to_head.Inverted();
    const double face = 0.5 * s.head_thickness, height = 0.2 * s.size;
    std::vector<TopoDS_Shape> stamps;
    for (const TopoDS_Shape& stroke :
         text_strokes(fmt::format("{:g}", s.size), height, 0.17 * height, face - 0.35, face + 1.0)) {
        stamps.push_back(moved(stroke, placement));
        stamps.push_back(moved(stamps.back(), below));
    }
    return stamps;
}

namespace {

// A smooth curve through points, parallel to X at both ends. `lift` maps (along, out) into space.
template <class Lift>
Handle(Geom_BSplineCurve) level_curve(const std::vector<gp_Pnt2d>& points, const Lift& lift) {
    Handle(TColgp_HArray1OfPnt) through = new TColgp_HArray1OfPnt(1, static_cast<int>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i)
        through->SetValue(static_cast<int>(i) + 1, lift(points[i]));
    GeomAPI_Interpolate curve(through, Standard_False, 1e-6);
    const gp_Vec level(points.back().X() > points.front().X() ? 1.0 : -1.0, 0.0, 0.0);
    curve.Load(level, level);
    curve.Perform();
    return curve.Curve();
}

// Points (x, half width) along the handle: waisted, a little wider towards the end.
std::vector<gp_Pnt2d> handle_side(const WrenchSpec& s, double inset, double from, double to) {
    const double half = 0.5 * s.handle_width;
    const auto width = [&](double x) {
        const double t = x / s.end;
        return half * (1.22 - 0.9 * t * (1.0 - t) + 0.06 * t) - inset;
    };
    std::vector<gp_Pnt2d> side;
    for (int i = 0; i <= 6; ++i) {
        const double x = from + (to - from) * i / 6.0;
        side.emplace_back(x, width(x));
    }
    return side;
}

// The handle, or a hollow in it, as an extruded outline: two waisted sides, a round far end, and a round or
// straight start.
TopoDS_Shape handle_plate(const WrenchSpec& s, double inset, double from, double to, bool round_start,
                          double z0, double z1) {
    const std::vector<gp_Pnt2d> side = handle_side(s, inset, from, to);
    const double r = side.back().Y(), r0 = side.front().Y();
    const auto up = level_curve(side, [&](const gp_Pnt2d& p) { return gp_Pnt(p.X(), p.Y(), z0); });
    const auto down = level_curve(side, [&](const gp_Pnt2d& p) { return gp_Pnt(p.X(), -p.Y(), z0); });
    BRepBuilderAPI_MakeWire wire;
    wire.Add(BRepBuilderAPI_MakeEdge(up).Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(
                 GC_MakeArcOfCircle(gp_Pnt(to, r, z0), gp_Pnt(to + r, 0.0, z0), gp_Pnt(to, -r, z0)).Value())
                 .Edge());
    wire.Add(BRepBuilderAPI_MakeEdge(down).Edge());
    if (round_start)
        wire.Add(BRepBuilderAPI_MakeEdge(GC_MakeArcOfCircle(gp_Pnt(from, -r0, z0), gp_Pnt(from - r0, 0.0, z0),
                                                            gp_Pnt(from, r0, z0))
                                             .Value())
                     .Edge());
    else
        wire.Add(BRepBuilderAPI_MakeEdge(gp_Pnt(from, -r0, z0), gp_Pnt(from, r0, z0)).Edge());
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()), gp_Vec(0.0, 0.0, z1 - z0));
}

// The space between the two broad faces: thick at the head, thinner along the handle.
TopoDS_Shape thickness_envelope(const WrenchSpec& s) {
    const double head = 0.5 * s.head_thickness, handle = 0.5 * s.handle_thickness;
    const double x0 = 0.42 * s.head_width, x1 = x0 + 1.3 * s.size, far = s.end + 10.0, near = -s.head_width;
    const double y = -2.0 * s.head_width, depth = 4.0 * s.head_width;
    const std::vector<gp_Pnt2d> top = {{x0, head}, {0.5 * (x0 + x1), 0.5 * (head + handle)}, {x1, handle}};
    const std::vector<gp_Pnt2d> bottom = {
        {x1, -handle}, {0.5 * (x0 + x1), -0.5 * (head + handle)}, {x0, -head}};
    const auto lift = [&](const gp_Pnt2d& p) { return gp_Pnt(p.X(), y, p.Y()); };
    const auto line = [&](double xa, double za, double xb, double zb) {
        return BRepBuilderAPI_MakeEdge(gp_Pnt(xa, y, za), gp_Pnt(xb, y, zb)).Edge();
    };
    BRepBuilderAPI_MakeWire wire(line(near, head, x0, head));
    wire.Add(BRepBuilderAPI_MakeEdge(level_curve(top, lift)).Edge());
    wire.Add(line(x1, handle, far, handle));
    wire.Add(line(far, handle, far, -handle));
    wire.Add(line(far, -handle, x1, -handle));
    wire.Add(BRepBuilderAPI_MakeEdge(level_curve(bottom, lift)).Edge());
    wire.Add(line(x0, -head, near, -head));
    wire.Add(line(near, -head, near, head));
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()), gp_Vec(0.0, depth, 0.0));
}

}  // namespace

WrenchSpec wrench_spec(double size, double grip) {
    WrenchSpec spec;
    spec.size = size;
    spec.jaw = size + 0.2;
    spec.head_angle = pi / 12.0;
    spec.head_width = 2.12 * size + 3.0;
    spec.head_thickness = 0.4 * size + 2.4;
    spec.handle_thickness = 0.27 * size + 2.2;
    spec.handle_width = 0.72 * size + 2.5;
    spec.end = grip + 50.0;  // half the width of a hand beyond the middle of the grip
    return spec;
}

Result<TopoDS_Shape> open_end_wrench(const WrenchSpec& s) {
    const gp_Trsf to_head = turn(gp::OZ(), s.head_angle);
    const double R = 0.5 * s.head_width;
    const double high = s.head_thickness;

    const TopoDS_Shape head = forged_head(s);
    const double r_end = handle_side(s, 0.0, 0.0, s.end).back().Y();
    TopoDS_Shape body =
        fused(moved(head, to_head), handle_plate(s, 0.0, 0.1 * s.size, s.end - r_end, false, -high, high));
    body = rounded(body, 1.1 * s.size, [&](const gp_Pnt& p, const gp_Dir& along) {  // the neck
        return upright(along) && p.X() > 0.5 * R && p.X() < 1.2 * R && std::abs(p.Y()) < 0.8 * R;
    });
    body = common(body, thickness_envelope(s));
    body = rounded(body, 0.2 * s.handle_thickness, [&](const gp_Pnt& p, const gp_Dir& along) {
        return !upright(along) && std::abs(p.Z()) > 0.25 * s.handle_thickness;
    });

    body = with_jaw(body, s);

    // Hollows on both sides of the handle leave an I section. The size is raised in them.
    const double rim = 0.17 * s.handle_width, depth = 0.17 * s.handle_thickness;
    const double z = 0.5 * s.handle_thickness, from = 0.42 * s.head_width + 1.75 * s.size,
                 to = s.end - 1.9 * r_end;
    TopoDS_Shape hollow = handle_plate(s, rim, from, to, true, z - depth, z + 5.0);
    hollow = rounded(hollow, 0.8 * depth, [&](const gp_Pnt& p, const gp_Dir& along) {
        return !upright(along) && std::abs(p.Z() - z + depth) < 1e-6;
    });
    const gp_Trsf over = turn(gp::OX(), pi);
    body = cut(body, {hollow, moved(hollow, over)});
    body = rounded(body, 0.4 * depth, [&](const gp_Pnt& p, const gp_Dir& along) {
        return !upright(along) && std::abs(std::abs(p.Z()) - z) < 1e-6 && p.X() > from - s.handle_width &&
               p.X() < to + s.handle_width && std::abs(p.Y()) < 0.5 * s.handle_width;
    });
    const std::string size = fmt::format("{:g}", s.size);
    const double letter = 0.7 * (handle_side(s, rim, from, to)[3].Y() * 2.0);
    std::vector<TopoDS_Shape> raised = {body};
    for (const auto& [text, at] : {std::pair<std::string, double>{size, 0.12}, {"CR-V", 0.8}})
        for (const TopoDS_Shape& stroke :
             text_strokes(text, letter, 0.16 * letter, z - depth - 0.2, z - 0.25 * depth)) {
            const TopoDS_Shape placed = moved(stroke, shift(from + at * (to - from), 0.0, 0.0));
            raised.push_back(placed);
            raised.push_back(moved(placed, over));
        }
    body = fused(raised);

    // The size is also stamped into the head, behind the throat. The handle has a hole to hang the wrench by.
    std::vector<TopoDS_Shape> out = size_stamps(s);
    out.push_back(revolved({{0.0, -high},
                            {0.28 * r_end + high - 0.5 * s.handle_thickness + 1.0, -high},
                            {0.28 * r_end + 1.0, -0.5 * s.handle_thickness},
                            {0.28 * r_end, -0.5 * s.handle_thickness + 1.0},
                            {0.28 * r_end, 0.5 * s.handle_thickness - 1.0},
                            {0.28 * r_end + 1.0, 0.5 * s.handle_thickness},
                            {0.28 * r_end + high - 0.5 * s.handle_thickness + 1.0, high},
                            {0.0, high}}));
    out.back() = moved(out.back(), shift(s.end - r_end, 0.0, 0.0));
    body = only_solid(cut(body, out));
    if (body.IsNull() || !is_valid_solid(body))
        return fail(ErrorCode::failed, fmt::format("wrench {}: is not one closed, valid solid", size),
                    "a solid of which OpenCASCADE reports no fault");
    return body;
}

Status add_wrench(CadDocument& document, double size, double grip) {
    BOLT_TRY_ASSIGN(const auto shape, open_end_wrench(wrench_spec(size, grip)));
    const std::string name = fmt::format("wrench_{:g}", size);
    document.add_instance(document.root(), name,
                          document.add_part(name + "_forging", shape, finish::chrome_vanadium));
    return {};
}

}  // namespace bolt::models
