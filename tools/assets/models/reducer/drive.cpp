#include "tools/assets/models/reducer/drive.hpp"

#include <BRepAdaptor_Surface.hxx>
#include <BRep_Builder.hxx>
#include <TopExp.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <cmath>
#include <gp_Ax3.hxx>
#include <gp_Cylinder.hxx>
#include <numbers>

#include "tools/assets/models/reducer/layout.hpp"
#include "tools/assets/models/reducer/shapes.hpp"

namespace bolt::models::reducer {
namespace {

using RadialOutline = std::vector<std::pair<double, double>>;

// The axis of a shaft; outlines about it are (radius, y).
gp_Ax2 axis_at(double x) { return {gp_Pnt(x, 0, 0), gp_Dir(0, 1, 0), gp_Dir(1, 0, 0)}; }

// A gear on the shaft at x with its mid plane at y. `turn` (rad) rotates it from the position in which the
// middle of a gap is on +X.
TopoDS_Shape gear_at(const GearSpec& gear, double x, double y, double turn,
                     const RadialOutline& inside = {}) {
    gp_Trsf placement, rotation;
    placement.SetTransformation(gp_Ax3(gp_Pnt(x, y, 0), gp_Dir(0, 1, 0), gp_Dir(1, 0, 0)), gp_Ax3());
    rotation.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), turn);
    return moved(gear_solid(gear, inside), placement * rotation);
}

// Keys of ISO/R 773, form A. `shaft` is the shaft's diameter; the table gives width, height and both depths
// for it.
struct ShaftKey {
    double x, y, length, shaft, width, height, shaft_depth, hub_depth;
};
constexpr ShaftKey key_input{0.0, -200.0, 50.0, 28.0, 8.0, 7.0, 4.0, 3.3};
constexpr ShaftKey key_wheel_1{150.0, 47.0, 50.0, 52.0, 16.0, 10.0, 6.0, 4.3};
constexpr ShaftKey key_wheel_2{350.0, -38.0, 70.0, 72.0, 20.0, 12.0, 7.5, 4.9};
constexpr ShaftKey key_output{350.0, 213.0, 70.0, 55.0, 16.0, 10.0, 6.0, 4.3};

TopoDS_Shape key_solid(const ShaftKey& key) {
    const gp_Ax2 frame(gp_Pnt(key.x, key.y, key.shaft / 2.0 - key.shaft_depth), gp_Dir(0, 0, 1),
                       gp_Dir(0, 1, 0));
    return extruded(rounded_rectangle(frame, key.length, key.width, key.width / 2.0),
                    gp_Vec(0, 0, key.height));
}

TopoDS_Shape hub_groove(const ShaftKey& key, double length) {
    return box({key.x - key.width / 2.0, key.x + key.width / 2.0, key.y - length, key.y + length, 0.0,
                key.shaft / 2.0 + key.hub_depth});
}

// A part whose tooth flanks have the finish of gear steel.
DrivePart toothed(std::string name, const TopoDS_Shape& solid) {
    // Hardened and ground teeth are darker than turned surfaces.
    DrivePart part{std::move(name), solid, finish::machined_steel, {}};
    TopTools_IndexedMapOfShape faces;
    TopExp::MapShapes(solid, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i) {
        const TopoDS_Face face = TopoDS::Face(faces(i));
        if (BRepAdaptor_Surface(face).GetType() == GeomAbs_BSplineSurface)
            part.faces.push_back({face, finish::gear_steel});
    }
    return part;
}

// The outline of rim, web and hub of a wheel, with chamfered corners.
RadialOutline wheel_inside(double half, double rim, double web, double hub, double bore) {
    const double w = web / 2.0;
    return {{rim + 1.5, half},  {rim, half - 1.5},     {rim - 2.0, w + 5.0},  {rim - 7.0, w},
            {hub + 7.0, w},     {hub + 2.0, w + 5.0},  {hub, half - 1.5},     {hub - 1.5, half},
            {bore + 2.0, half}, {bore, half - 2.0},    {bore, 2.0 - half},    {bore + 2.0, -half},
            {hub - 1.5, -half}, {hub, 1.5 - half},     {hub + 2.0, -w - 5.0}, {hub + 7.0, -w},
            {rim - 7.0, -w},    {rim - 2.0, -w - 5.0}, {rim, 1.5 - half},     {rim + 1.5, -half}};
}

TopoDS_Shape with_web_holes(const TopoDS_Shape& wheel, double x, double y, double pitch_radius,
                            double radius) {
    Shapes holes;
    for (int i = 0; i < 6; ++i) {
        const double angle = std::numbers::pi / 6.0 + i * std::numbers::pi / 3.0;
        holes.push_back(cylinder_y(x + pitch_radius * std::cos(angle), pitch_radius * std::sin(angle),
                                   y - 30.0, y + 30.0, radius));
    }
    return cut(wheel, holes);
}

TopoDS_Shape sleeve(double x, double y0, double y1, double inner, double outer) {
    return revolved(axis_at(x), {{inner, y0},
                                 {outer - 1.0, y0},
                                 {outer, y0 + 1.0},
                                 {outer, y1 - 1.0},
                                 {outer - 1.0, y1},
                                 {inner, y1}});
}

}  // namespace

Result<DrivePart> input_shaft() {
    return catch_build_errors("input shaft", [] {
        const double start = pair_1_y - pinion_1.width_mm / 2.0, end = pair_1_y + pinion_1.width_mm / 2.0;
        const TopoDS_Shape left = revolved(axis_at(0.0), {{0, -230},
                                                          {13, -230},
                                                          {14, -229},
                                                          {14, -170},
                                                          {15, -169.5},
                                                          {15, -100},
                                                          {18.5, -100},
                                                          {18.5, start - 5},
                                                          {17.5, start - 4},
                                                          {17.5, start},
                                                          {0, start}});
        const TopoDS_Shape right = revolved(axis_at(0.0), {{0, end},
                                                           {17.5, end},
                                                           {17.5, end + 4},
                                                           {18.5, end + 5},
                                                           {18.5, 100},
                                                           {15, 100},
                                                           {15, 120},
                                                           {14, 121},
                                                           {0, 121}});
        const TopoDS_Shape pinion = gear_at(pinion_1, 0.0, pair_1_y, std::numbers::pi / pinion_1.teeth);
        const TopoDS_Shape shaft = cut(fused({pinion, left, right}), {key_solid(key_input)});
        return toothed("shaft_input", one_solid("input shaft", shaft));
    });
}

Result<DrivePart> intermediate_shaft() {
    return catch_build_errors("intermediate shaft", [] {
        const double start = pair_2_y - pinion_2.width_mm / 2.0, end = pair_2_y + pinion_2.width_mm / 2.0;
        const TopoDS_Shape left = revolved(
            axis_at(shafts[1].x),
            {{0, -127}, {21.5, -127}, {22.5, -126}, {22.5, -100}, {27, -100}, {27, start}, {0, start}});
        const TopoDS_Shape right = revolved(axis_at(shafts[1].x), {{0, end},
                                                                   {27, end},
                                                                   {27, end + 4},
                                                                   {31, end + 5},
                                                                   {31, 18},
                                                                   {26, 18},
                                                                   {26, 76},
                                                                   {22.5, 77},
                                                                   {22.5, 126},
                                                                   {21.5, 127},
                                                                   {0, 127}});
        const TopoDS_Shape pinion =
            gear_at(pinion_2, shafts[1].x, pair_2_y, std::numbers::pi / pinion_2.teeth);
        const TopoDS_Shape shaft = cut(fused({pinion, left, right}), {key_solid(key_wheel_1)});
        return toothed("shaft_intermediate", one_solid("intermediate shaft", shaft));
    });
}

Result<DrivePart> output_shaft() {
    return catch_build_errors("output shaft", [] {
        const TopoDS_Shape body = revolved(axis_at(shafts[2].x), {{0, -125},
                                                                  {31.5, -125},
                                                                  {32.5, -124},
                                                                  {32.5, -77},
                                                                  {36, -76},
                                                                  {36, 2},
                                                                  {43, 2},
                                                                  {43, 14},
                                                                  {37.5, 18},
                                                                  {37.5, 100},
                                                                  {32.5, 100},
                                                                  {32.5, 126},
                                                                  {30, 128},
                                                                  {30, 171},
                                                                  {27.5, 172},
                                                                  {27.5, 252},
                                                                  {26, 253.5},
                                                                  {0, 253.5}});
        const TopoDS_Shape shaft = cut(body, {key_solid(key_wheel_2), key_solid(key_output)});
        return DrivePart{"shaft_output", one_solid("output shaft", shaft), finish::machined_steel, {}};
    });
}

Result<DrivePart> first_wheel() {
    return catch_build_errors("first wheel", [] {
        const double x = shafts[1].x;
        const RadialOutline inside = wheel_inside(wheel_1.width_mm / 2.0, 113.0, 18.0, 42.0, 26.0);
        const TopoDS_Shape wheel =
            with_web_holes(gear_at(wheel_1, x, pair_1_y, std::numbers::pi, inside), x, pair_1_y, 77.5, 17.0);
        return toothed("wheel_1", one_solid("first wheel", cut(wheel, {hub_groove(key_wheel_1, 60.0)})));
    });
}

Result<DrivePart> second_wheel() {
    return catch_build_errors("second wheel", [] {
        const double x = shafts[2].x;
        const RadialOutline inside = wheel_inside(wheel_2.width_mm / 2.0, 147.0, 22.0, 57.0, 36.0);
        const TopoDS_Shape wheel =
            with_web_holes(gear_at(wheel_2, x, pair_2_y, std::numbers::pi, inside), x, pair_2_y, 102.0, 22.0);
        return toothed("wheel_2", one_solid("second wheel", cut(wheel, {hub_groove(key_wheel_2, 80.0)})));
    });
}

Result<std::vector<DrivePart>> keys_and_sleeves() {
    return catch_build_errors("keys and sleeves", [] {
        const auto part = [](std::string name, const TopoDS_Shape& shape) {
            return DrivePart{name, one_solid(name, shape), finish::machined_steel, {}};
        };
        return std::vector<DrivePart>{part("key_input", key_solid(key_input)),
                                      part("key_wheel_1", key_solid(key_wheel_1)),
                                      part("key_wheel_2", key_solid(key_wheel_2)),
                                      part("key_output", key_solid(key_output)),
                                      part("sleeve_wheel_1", sleeve(shafts[1].x, 78.0, 100.0, 22.5, 27.5)),
                                      part("sleeve_wheel_2", sleeve(shafts[2].x, -100.0, -78.0, 32.5, 38.0))};
    });
}

// ISO 15 defines bore, outer diameter and width. The inside follows common practice: rollers half as thick as
// the section, which fill their circle except for the cage, two ribs on the outer ring and one on the inner.
Result<TopoDS_Shape> roller_bearing(double bore, double outer, double width) {
    return catch_build_errors("roller bearing", [&] {
        const gp_Ax2 axis(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1));
        const double pitch = (bore + outer) / 4.0, half = width / 2.0, chamfer = 1.2;
        const double roller = (outer - bore) / 8.0, length = 0.56 * width, side = length / 2.0 + 0.1,
                     play = 0.02;
        const double rib = 0.6 * roller, in = bore / 2.0, out = outer / 2.0;
        const double in_race = pitch - roller - play, out_race = pitch + roller + play;
        const int rollers = static_cast<int>(std::floor(std::numbers::pi * pitch / (1.18 * roller)));
        TopoDS_Compound bearing;
        BRep_Builder builder;
        builder.MakeCompound(bearing);
        builder.Add(bearing, one_solid("inner ring", revolved(axis, {{in + chamfer, -half},
                                                                     {in_race, -half},
                                                                     {in_race, side},
                                                                     {in_race + rib, side},
                                                                     {in_race + rib, half},
                                                                     {in + chamfer, half},
                                                                     {in, half - chamfer},
                                                                     {in, chamfer - half}})));
        builder.Add(bearing, one_solid("outer ring", revolved(axis, {{out - chamfer, -half},
                                                                     {out, chamfer - half},
                                                                     {out, half - chamfer},
                                                                     {out - chamfer, half},
                                                                     {out_race - rib, half},
                                                                     {out_race - rib, side},
                                                                     {out_race, side},
                                                                     {out_race, -side},
                                                                     {out_race - rib, -side},
                                                                     {out_race - rib, -half}})));
        for (const double end : {-1.0, 1.0}) {
            const double z0 = end * (side + 0.1), z1 = end * (side + 2.0), r = 0.3 * roller;
            builder.Add(bearing,
                        revolved(axis, {{pitch - r, z0}, {pitch + r, z0}, {pitch + r, z1}, {pitch - r, z1}}));
        }
        for (int i = 0; i < rollers; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / rollers;
            const gp_Pnt at(pitch * std::cos(angle), pitch * std::sin(angle), -length / 2.0);
            builder.Add(bearing, cylinder(gp_Ax2(at, gp_Dir(0, 0, 1)), roller, length));
        }
        return TopoDS_Shape(bearing);
    });
}

}  // namespace bolt::models::reducer
