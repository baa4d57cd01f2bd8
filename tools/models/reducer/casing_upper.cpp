#include "tools/models/reducer/casing.hpp"
#include "tools/models/reducer/casing_parts.hpp"
#include "tools/models/reducer/fittings.hpp"

namespace bolt::models::reducer {
namespace {

// From the crest of a bearing boss up to the wall.
TopoDS_Shape upper_rib(const ShaftPlace& shaft) {
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

struct Eye {
    double x, z, root_x, root_z;
};
constexpr std::array<Eye, 2> eyes{{{-44.0, 128.0, -30.0, 84.0}, {512.0, 138.0, 462.0, 92.0}}};

}  // namespace

Result<Casting> casing_upper() {
    return guarded("upper casing", [] {
        const TopoDS_Shape outside = housing(contour_upper, 0.0, half_width, 14.0);
        TopoDS_Shape half = side_bosses(
            blended("upper flange", common(outside, half_space_y()), flange_half(0.0), 6.0, on_rim), 0.0);
        for (const ShaftPlace& shaft : shafts) half = blended("upper rib", half, upper_rib(shaft), 3.0);
        TopoDS_Shape whole = merged_faces(fused({half, mirrored_y(half)}));
        whole = blended("cover seat", whole, hatch_block(hatch.length, hatch.width, hatch.corner, -14.0, 0.0),
                        4.0);
        Shapes tools = machining(true);
        for (const Eye& eye : eyes) {
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

}  // namespace bolt::models::reducer
