#include "tools/models/reducer/casing.hpp"
#include "tools/models/reducer/casing_parts.hpp"
#include "tools/models/reducer/fittings.hpp"

// Built upside down, as the upper half is, and turned over at the end.
namespace bolt::models::reducer {
namespace {

// From the underside of a bearing boss down to the foot, or running out in the wall where there is none.
TopoDS_Shape lower_rib(const ShaftPlace& shaft, bool to_foot) {
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

constexpr double hook_x = 19.0, hook_z = 71.0;  // of the rope's seat, from the wall and the parting plane

// Under the end flange: a nose to hang a rope on, its seat cut later. `out` points away from the casing's
// middle; upside down as all here.
TopoDS_Shape hook(double wall_x, double out) {
    const auto at = [&](double x, double z) { return gp_Pnt(wall_x + out * x, -10.0, z); };
    return lug(polygon({at(-14, 14), at(42, 14), at(42, 64), at(30, 76), at(-14, 106)}));
}

TopoDS_Shape boss_in(const gp_Trsf& frame, double radius, double depth) {
    return moved(cylinder_z(0, 0, -depth, 0, radius), frame);
}

}  // namespace

Result<Casting> casing_lower() {
    return guarded("lower casing", [] {
        const TopoDS_Shape outside = housing(contour_lower, 0.0, half_width, 10.0);
        TopoDS_Shape half = side_bosses(
            blended("lower flange", common(outside, half_space_y()), flange_half(misfit), 6.0, on_rim),
            misfit);
        for (const double x : feet) half = blended("foot", half, foot(x), 4.0);
        for (const ShaftPlace& shaft : shafts) {
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
