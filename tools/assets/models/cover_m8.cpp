// The housing with a cover on four bolts M8 (shipped.hpp).
#include <fmt/format.h>

#include <cmath>

#include "engine/base/math.hpp"
#include "tools/assets/models/fasteners.hpp"
#include "tools/assets/models/shipped.hpp"
#include "tools/assets/models/solids.hpp"

namespace bolt::models {

namespace {

constexpr double half_x = 50.0, half_y = 40.0;  // the bolts stand at (±half_x, ±half_y)
constexpr double cover_top = 10.0, cover_thickness = 6.0, rim_thickness = 10.0;
constexpr double parting = cover_top - cover_thickness, under = parting - rim_thickness;  // z of faces
constexpr double cover_length = 128.0, cover_width = 108.0, corner_radius = 14.0;
constexpr double hole = 9.0;  // ISO 273, medium
constexpr double housing_bottom = -62.0;

std::vector<TopoDS_Shape> drills(double from, double to) {
    std::vector<TopoDS_Shape> result;
    for (const double x : {-half_x, half_x})
        for (const double y : {-half_y, half_y})
            result.push_back(cylinder(gp_Ax2(gp_Pnt(x, y, from), gp::DZ()), 0.5 * hole, to - from));
    return result;
}

// An edge that does not run along Z.
bool is_flat(const gp_Dir& along) { return std::abs(along.Z()) < 0.5; }

TopoDS_Shape housing() {
    // The rim carries the machined parting face; below it is a box with a foot.
    TopoDS_Shape rim = rounded_block(0.0, 0.0, cover_length, cover_width, corner_radius, under, parting);
    rim = rounded(rim, 2.0, [](const gp_Pnt& p, const gp_Dir&) { return std::abs(p.Z() - under) < 1e-6; });
    TopoDS_Shape body = rounded_block(0.0, 0.0, 70.0, 50.0, 12.0, housing_bottom, under + 1.0);
    TopoDS_Shape foot = rounded_block(0.0, 0.0, 110.0, 84.0, 12.0, housing_bottom, housing_bottom + 9.0);
    foot = rounded(foot, 2.0, [](const gp_Pnt& p, const gp_Dir&) {
        return std::abs(p.Z() - housing_bottom - 9.0) < 1e-6;
    });
    TopoDS_Shape casting = fused({rim, body, foot});
    casting = rounded(casting, 5.0, [](const gp_Pnt& p, const gp_Dir& along) {
        const bool under_rim = std::abs(p.Z() - under) < 1e-6,
                   on_foot = std::abs(p.Z() - housing_bottom - 9.0) < 1e-6;
        return (under_rim || on_foot) && is_flat(along) && std::abs(p.X()) < 35.1 && std::abs(p.Y()) < 25.1;
    });
    const TopoDS_Shape cavity = rounded_block(0.0, 0.0, 58.0, 38.0, 7.0, housing_bottom + 8.0, parting + 1.0);
    std::vector<TopoDS_Shape> out = drills(under - 1.0, parting + 1.0);
    out.push_back(cavity);
    for (const double x : {-46.0, 46.0})
        for (const double y : {-32.0, 32.0})
            out.push_back(cylinder(gp_Ax2(gp_Pnt(x, y, housing_bottom - 1.0), gp::DZ()), 3.5, 12.0));
    return bevelled(cut(casting, out), 0.6, [](const gp_Pnt& p, const gp_Dir& along) {
        return std::abs(p.Z() - parting) < 1e-6 && is_flat(along);
    });
}

TopoDS_Shape cover() {
    TopoDS_Shape plate =
        rounded_block(0.0, 0.0, cover_length, cover_width, corner_radius, parting, cover_top);
    const TopoDS_Shape raised = rounded_block(0.0, 0.0, 66.0, 46.0, 12.0, cover_top - 1.0, cover_top + 7.0);
    plate = fused(plate, raised);
    plate = rounded(plate, 3.0, [](const gp_Pnt& p, const gp_Dir& along) {
        const bool inside = std::abs(p.X()) < 34.0 && std::abs(p.Y()) < 24.0;
        return inside && is_flat(along) &&
               (std::abs(p.Z() - cover_top) < 1e-6 || std::abs(p.Z() - cover_top - 7.0) < 1e-6);
    });
    plate = cut(plate, drills(parting - 1.0, cover_top + 1.0));
    plate = cut(plate, cylinder(gp_Ax2(gp_Pnt(0.0, 0.0, cover_top - 1.0), gp::DZ()), 7.0, 20.0));
    return bevelled(plate, 0.8, [](const gp_Pnt& p, const gp_Dir& along) {
        const bool rim = std::abs(std::abs(p.X()) - 0.5 * cover_length) < 5.0 ||
                         std::abs(std::abs(p.Y()) - 0.5 * cover_width) < 5.0;
        return rim && is_flat(along) && std::abs(p.Z() - cover_top) < 1e-6;
    });
}

}  // namespace

Status add_cover_m8(CadDocument& document) {
    const TopoDS_Shape housing_shape = only_solid(housing()), cover_shape = only_solid(cover());
    if (housing_shape.IsNull() || cover_shape.IsNull() || !is_valid_solid(housing_shape) ||
        !is_valid_solid(cover_shape))
        return fail(ErrorCode::failed, "cover-m8: housing or cover is not one closed, valid solid",
                    "a solid of which OpenCASCADE reports no fault");
    document.add_instance(document.root(), "housing",
                          document.add_part("housing_casting", housing_shape, finish::painted_cast_iron));
    document.add_instance(document.root(), "cover",
                          document.add_part("cover_plate", cover_shape, finish::stainless_steel));
    BOLT_TRY_ASSIGN(const auto plug, socket_screw(*iso_4762("M12", 10.0)));  // closes the oil hole
    document.add_instance(document.root(), "filler_plug",
                          document.add_part("plug_M12", plug, finish::black_oxide),
                          turn(gp_Ax1(gp_Pnt(0.0, 0.0, 0.5 * (cover_top + 7.0)), gp::DX()), pi));

    BOLT_TRY_ASSIGN(const auto fasteners,
                    add_fasteners(document, "M8", 30.0, finish::zinc_plated, nullptr, "8.8"));
    const double at[4][2] = {{-half_x, half_y}, {half_x, half_y}, {half_x, -half_y}, {-half_x, -half_y}};
    for (int i = 0; i < 4; ++i)
        add_joint(document, document.root(), fmt::format("B{}", i + 1), fasteners,
                  cover_thickness + rim_thickness, shift(at[i][0], at[i][1], cover_top));
    return {};
}

}  // namespace bolt::models
