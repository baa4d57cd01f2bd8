// The click torque wrench (shipped.hpp).
#include <fmt/format.h>

#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <array>
#include <cmath>
#include <gp_Ax3.hxx>

#include "engine/base/math.hpp"
#include "tools/assets/models/glyphs.hpp"
#include "tools/assets/models/shipped.hpp"
#include "tools/assets/models/solids.hpp"
#include "tools/assets/models/wrench.hpp"

namespace bolt::models {

namespace {

// The x of the far end of each part, in the order along the wrench, mm.
constexpr double insert_end = 62.0, holder_end = 112.0, tube_end = 336.0, ring_end = 341.0,
                 sleeve_end = 377.0, grip_end = 492.0, knob_end = 508.0;
constexpr double tube_radius = 12.5, scale_from = 215.0, scale_to = 315.0;  // 40 to 200 N·m
constexpr double flat = tube_radius - 1.2;  // height of the flat with the scale

// Rotates a turned part, which is built about Z, to lie along X with its z = 0 at x = 0.
TopoDS_Shape along_x(const TopoDS_Shape& shape) {
    gp_Trsf trsf;
    trsf.SetTransformation(gp_Ax3(gp_Pnt(0.0, 0.0, 0.0), gp::DX(), gp::DY()), gp_Ax3(gp::XOY()));
    return moved(shape, trsf);
}

// A sleeve with a straight knurl: V grooves of 90° along the axis, with bevelled ends.
TopoDS_Shape knurled(double radius, double depth, int teeth, double from, double to) {
    BRepBuilderAPI_MakePolygon star;
    for (int i = 0; i < 2 * teeth; ++i) {
        const double r = i % 2 == 0 ? radius : radius - depth, angle = i * pi / teeth;
        star.Add(gp_Pnt(r * std::cos(angle), r * std::sin(angle), from));
    }
    star.Close();
    const TopoDS_Shape prism =
        BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(star.Wire()), gp_Vec(0.0, 0.0, to - from));
    const double bevel = 1.6 * depth;
    return common(prism, revolved({{0.0, from},
                                   {radius - bevel, from},
                                   {radius, from + bevel},
                                   {radius, to - bevel},
                                   {radius - bevel, to},
                                   {0.0, to}}));
}

Result<TopoDS_Shape> insert(const WrenchSpec& s) {
    const double t = 0.5 * s.head_thickness;
    const TopoDS_Shape shank =
        box(gp_Pnt(0.3 * s.size, -14.0, -s.head_thickness), gp_Pnt(insert_end + 6.0, 14.0, s.head_thickness));
    TopoDS_Shape body = fused(forged_head(s), shank);
    body = rounded(body, 12.0, [&](const gp_Pnt& p, const gp_Dir& along) {
        return upright(along) && p.X() > 10.0 && p.X() < 0.6 * s.head_width &&
               std::abs(std::abs(p.Y()) - 14.0) < 1e-3;
    });
    body = common(body, box(gp_Pnt(-100.0, -100.0, -t), gp_Pnt(insert_end + 6.0, 100.0, t)));
    body = rounded(body, 1.6, [&](const gp_Pnt& p, const gp_Dir& along) {
        return !upright(along) && std::abs(std::abs(p.Z()) - t) < 1e-6 && p.X() < insert_end + 5.0;
    });
    body = only_solid(cut(with_jaw(body, s), size_stamps(s)));
    if (body.IsNull() || !is_valid_solid(body))
        return fail(ErrorCode::failed, "torque wrench insert: is not one closed, valid solid",
                    "a solid of which OpenCASCADE reports no fault");
    return body;
}

// The housing that holds the insert: square, then round where the tube is pressed in.
TopoDS_Shape holder() {
    TopoDS_Shape square =
        moved(rounded_block(0.0, 0.0, 34.0, 26.0, 5.0, 0.0, 38.0), shift(0.0, 0.0, insert_end));
    square = bevelled(square, 1.2, [](const gp_Pnt& p, const gp_Dir& along) {
        return std::abs(along.Z()) < 0.5 && std::abs(p.Z() - insert_end) < 1e-6;
    });
    square = rounded(square, 3.0, [](const gp_Pnt& p, const gp_Dir& along) {
        return std::abs(along.Z()) < 0.5 && std::abs(p.Z() - insert_end - 38.0) < 1e-6;
    });
    ProfileOutline neck({0.0, insert_end + 30.0});
    neck.line({12.9, insert_end + 30.0})
        .line({12.9, holder_end - 9.0})
        .line({14.0, holder_end - 7.0})
        .line({14.0, holder_end - 1.0})
        .line({13.0, holder_end})
        .line({0.0, holder_end});
    TopoDS_Shape body = fused(square, revolved(neck));
    // The catch that holds the insert: a pin in a countersunk hole on the −X side (before along_x).
    const TopoDS_Shape pocket = cylinder(gp_Ax2(gp_Pnt(-20.0, 0.0, insert_end + 16.0), gp::DX()), 4.2, 4.6);
    const TopoDS_Shape pin = cylinder(gp_Ax2(gp_Pnt(-17.0, 0.0, insert_end + 16.0), gp::DX()), 3.4, 6.0);
    return along_x(fused(cut(body, pocket), pin));
}

TopoDS_Shape tube() {
    const TopoDS_Shape round = along_x(revolved({{0.0, holder_end - 2.0},
                                                 {tube_radius, holder_end - 2.0},
                                                 {tube_radius, tube_end - 1.0},
                                                 {tube_radius - 1.0, tube_end},
                                                 {0.0, tube_end}}));
    std::vector<TopoDS_Shape> out = {
        box(gp_Pnt(scale_from - 17.0, -20.0, flat), gp_Pnt(scale_to + 10.0, 20.0, flat + 20.0))};
    for (int torque = 40; torque <= 200; torque += 10) {
        const double x = scale_from + (scale_to - scale_from) * (torque - 40) / 160.0;
        const double length = torque % 20 == 0 ? 3.2 : 1.8;
        out.push_back(box(gp_Pnt(x - 0.2, -4.6, flat - 0.3), gp_Pnt(x + 0.2, -4.6 + length, flat + 1.0)));
        if (torque % 40 != 0) continue;
        for (const TopoDS_Shape& stroke :
             text_strokes(fmt::format("{}", torque), 3.4, 0.45, flat - 0.3, flat + 1.0))
            out.push_back(moved(stroke, shift(x, 1.3, 0.0)));
    }
    for (const TopoDS_Shape& stroke : text_strokes("N*m", 3.4, 0.45, flat - 0.3, flat + 1.0))
        out.push_back(moved(stroke, shift(scale_from - 10.5, 1.3, 0.0)));
    return cut(round, out);
}

TopoDS_Shape grip() {
    const double z0 = sleeve_end, z1 = grip_end, mid = 0.5 * (z0 + z1);
    ProfileOutline outline({0.0, z0});
    outline.line({14.5, z0})
        .arc({15.6, z0 + 0.5}, {16.0, z0 + 1.6})
        .line({16.0, z0 + 10.0})
        .line({15.3, mid - 15.0})  // barely waisted
        .line({15.3, mid + 15.0})
        .line({16.0, z1 - 10.0})
        .line({16.0, z1 - 1.6})
        .arc({15.6, z1 - 0.5}, {14.5, z1})
        .line({0.0, z1});
    std::vector<TopoDS_Shape> flutes;
    for (int i = 0; i < 16; ++i) {
        const double angle = i * pi / 8.0, r = 17.6;
        const gp_Pnt foot(r * std::cos(angle), r * std::sin(angle), z0 + 14.0);
        flutes.push_back(cylinder(gp_Ax2(foot, gp::DZ()), 2.6, z1 - z0 - 28.0));
    }
    return along_x(cut(revolved(outline), flutes));
}

TopoDS_Shape ring() {
    return along_x(revolved({{tube_radius - 3.0, tube_end},
                             {14.2, tube_end},
                             {14.7, tube_end + 0.5},
                             {14.7, ring_end - 0.5},
                             {14.2, ring_end},
                             {tube_radius - 3.0, ring_end}}));
}

TopoDS_Shape knob() {
    return along_x(fused(cylinder(gp_Ax2(gp_Pnt(0.0, 0.0, grip_end - 1.0), gp::DZ()), 9.0, 4.0),
                         knurled(13.0, 0.7, 40, grip_end + 2.0, knob_end)));
}

// The floors of the marks that are cut into the flat: they are painted black.
std::vector<FaceFinish> scale_marks(const TopoDS_Shape& shape) {
    std::vector<FaceFinish> marks;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next()) {
        const TopoDS_Face face = TopoDS::Face(faces.Current());
        const BRepAdaptor_Surface surface(face);
        if (surface.GetType() != GeomAbs_Plane) continue;
        const gp_Pln plane = surface.Plane();
        const bool level = std::abs(plane.Axis().Direction().Z()) > 0.999;
        if (level && std::abs(plane.Location().Z() - (flat - 0.3)) < 1e-6)
            marks.push_back({face, finish::black_oxide});
    }
    return marks;
}

}  // namespace

Status add_torque_wrench(CadDocument& document, double size) {
    WrenchSpec spec = wrench_spec(size, 0.5 * (sleeve_end + grip_end));
    spec.head_angle = 0.0;
    BOLT_TRY_ASSIGN(const auto head, insert(spec));
    struct WrenchPart {
        std::string_view name;
        TopoDS_Shape shape;
        Finish finish;
    };
    const WrenchPart wrench_parts[] = {
        {"insert", head, finish::chrome_vanadium},
        {"holder", holder(), finish::black_oxide},
        {"tube", tube(), finish::chrome_vanadium},
        {"ring", ring(), finish::signal_red},
        {"sleeve", along_x(knurled(15.2, 0.7, 48, ring_end, sleeve_end)), finish::chrome_vanadium},
        {"grip", grip(), finish::rubber},
        {"knob", knob(), finish::black_oxide}};
    for (const WrenchPart& part_to_add : wrench_parts) {
        const TopoDS_Shape solid = only_solid(part_to_add.shape);
        if (solid.IsNull() || !is_valid_solid(solid))
            return fail(ErrorCode::failed,
                        fmt::format("torque wrench {}: is not one closed, valid solid", part_to_add.name),
                        "a solid of which OpenCASCADE reports no fault");
        const CadPart part =
            document.add_part(fmt::format("torque_wrench_{}", part_to_add.name), solid, part_to_add.finish,
                              part_to_add.name == "tube" ? scale_marks(solid) : std::vector<FaceFinish>{});
        document.add_instance(document.root(), part_to_add.name, part);
    }
    return {};
}

}  // namespace bolt::models
