#include "tools/assets/models/reducer/casing.hpp"

#include "tools/assets/models/reducer/casing_parts.hpp"
#include "tools/assets/models/reducer/fittings.hpp"

namespace bolt::models::reducer {
namespace {

// From the crest of a bearing boss up to the wall.
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

// From the underside of a bearing boss down to the foot, or ending in the wall where there is no foot.
TopoDS_Shape lower_rib(const ShaftLayout& shaft, bool to_foot) {
    const double r = shaft.boss_radius + misfit;
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
// casing's middle. It is upside down, as the whole lower half is.
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

// The lower half is built upside down, as the upper half is, and turned over before its holes are cut.
Result<Casting> casing_lower() {
    return catch_build_errors("lower casing", [] {
        const TopoDS_Shape outside = housing(contour_lower, 0.0, half_width, 10.0);
        TopoDS_Shape half = side_bosses(
            blended("lower flange", common(outside, half_space_y()), flange_half(misfit), 6.0, on_rim),
            misfit);
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

}  // namespace bolt::models::reducer
