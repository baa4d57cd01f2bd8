// Tests of the parts of the shipped reducer: valid solids, plausible masses, no overlaps.
#include <doctest/doctest.h>

#include <BRepCheck_Analyzer.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRep_Tool.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <cmath>

#include "shipped.hpp"
#include "tools/assets/models/reducer/layout.hpp"

namespace {

using namespace reducer_test;
using namespace bolt::models::reducer;

constexpr double iron = 7.2e-6, steel = 7.85e-6;  // kg/mm3

int solids(const TopoDS_Shape& shape) {
    int n = 0;
    for (TopExp_Explorer e(shape, TopAbs_SOLID); e.More(); e.Next()) ++n;
    return n;
}

// The volume that a gear sweeps when it turns.
TopoDS_Shape swept(const GearSpec& gear, double x, double y, double margin) {
    const double radius = circles(gear).tip_mm / 2.0 + margin, half = gear.width_mm / 2.0 + margin;
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(x, y - half, 0), gp_Dir(0, 1, 0)), radius, 2.0 * half)
        .Shape();
}

}  // namespace

TEST_CASE("Reducer: every part consists of valid closed solids of positive volume") {
    for (const auto& [name, placed] : shipped()) {
        CAPTURE(name);
        CHECK(solids(placed.shape) >= 1);
        CHECK(BRepCheck_Analyzer(placed.shape).IsValid());
        for (TopExp_Explorer e(placed.shape, TopAbs_SHELL); e.More(); e.Next())
            CHECK(BRep_Tool::IsClosed(TopoDS::Shell(e.Current())));
        CHECK(volume(placed.shape) > 0.0);
    }
    for (const char* casting : {"casing_upper", "casing_lower"}) CHECK(solids(part(casting)) == 1);
}

TEST_CASE("Reducer: masses are plausible for its size") {
    const double upper = volume(part("casing_upper")) * iron, lower = volume(part("casing_lower")) * iron;
    MESSAGE("upper " << upper << " kg, lower " << lower << " kg, wheel " << volume(part("wheel_2")) * steel
                     << " kg");
    CHECK(upper > 25.0);
    CHECK(upper < 60.0);
    CHECK(lower > 35.0);
    CHECK(lower < 80.0);
    // A wheel weighs between a third of its tip circle's disc and the whole disc.
    const double disc = volume(swept(wheel_2, 0, 0, 0.0));
    CHECK(volume(part("wheel_2")) < disc);
    CHECK(volume(part("wheel_2")) > disc / 3.0);
    double all = 0.0;
    for (const auto& [name, placed] : shipped())
        all += volume(placed.shape) * (name.rfind("casing", 0) == 0 ? iron : steel);
    CHECK(all > 150.0);  // catalogues give about 200 kg for a ZQ350
    CHECK(all < 280.0);
}

TEST_CASE("Reducer: turning gears keep at least 5 mm clearance to the casing") {
    const struct {
        const GearSpec* gear;
        double x, y;
    } gears[] = {{&pinion_1, shafts[0].x, pair_1_y},
                 {&wheel_1, shafts[1].x, pair_1_y},
                 {&pinion_2, shafts[1].x, pair_2_y},
                 {&wheel_2, shafts[2].x, pair_2_y}};
    for (const auto& g : gears)
        for (const char* half : {"casing_upper", "casing_lower"}) {
            CAPTURE(g.gear->teeth);
            CAPTURE(half);
            CHECK(distance(swept(*g.gear, g.x, g.y, 0.0), part(half)) >= 5.0);
        }
    // The wheels of one shaft do not reach the other shafts.
    CHECK(distance(swept(wheel_1, shafts[1].x, pair_1_y, 0.0), part("shaft_output")) > 5.0);
    CHECK(distance(swept(wheel_2, shafts[2].x, pair_2_y, 0.0), part("shaft_input")) > 5.0);
    CHECK(distance(swept(wheel_1, shafts[1].x, pair_1_y, 0.0), swept(wheel_2, shafts[2].x, pair_2_y, 0.0)) >
          5.0);
}

TEST_CASE("Reducer: no part overlaps another") {
    std::vector<std::pair<std::string, std::string>> near = {{"casing_upper", "casing_lower"},
                                                             {"shaft_intermediate", "wheel_1"},
                                                             {"shaft_output", "wheel_2"},
                                                             {"key_wheel_1", "wheel_1"},
                                                             {"key_wheel_2", "wheel_2"},
                                                             {"key_wheel_1", "shaft_intermediate"},
                                                             {"key_wheel_2", "shaft_output"},
                                                             {"key_input", "shaft_input"},
                                                             {"key_output", "shaft_output"},
                                                             {"sleeve_wheel_1", "wheel_1"},
                                                             {"sleeve_wheel_2", "wheel_2"},
                                                             {"sleeve_wheel_1", "shaft_intermediate"},
                                                             {"sleeve_wheel_2", "shaft_output"},
                                                             {"seal_input_front", "shaft_input"},
                                                             {"seal_output_back", "shaft_output"},
                                                             {"cap_input_front", "shaft_input"},
                                                             {"cap_output_back", "shaft_output"},
                                                             {"cap_input_front", "seal_input_front"},
                                                             {"cap_output_back", "seal_output_back"},
                                                             {"cover_plate", "cover_gasket"},
                                                             {"cover_gasket", "casing_upper"},
                                                             {"cover_plate", "casing_upper"},
                                                             {"cover_plate", "breather"},
                                                             {"cover_screw_1", "casing_upper"},
                                                             {"cover_screw_1", "cover_plate"},
                                                             {"sight_glass", "sight_glass_bezel"},
                                                             {"sight_glass_bezel", "casing_lower"},
                                                             {"drain_plug", "casing_lower"},
                                                             {"drain_plug", "drain_ring"},
                                                             {"drain_ring", "casing_lower"},
                                                             {"nameplate", "casing_upper"},
                                                             {"oil", "casing_lower"},
                                                             {"oil", "wheel_1"},
                                                             {"oil", "wheel_2"},
                                                             {"dowel_1", "casing_upper"},
                                                             {"dowel_2", "casing_lower"}};
    const char* const shafts_by_name[] = {"input", "intermediate", "output"};
    for (const std::string shaft : shafts_by_name)
        for (const std::string side : {"front", "back"}) {
            const std::string end = shaft + "_" + side;
            near.emplace_back("bearing_" + end, "shaft_" + shaft);
            near.emplace_back("bearing_" + end, "cap_" + end);
            near.emplace_back("cap_" + end + "_screw_1", "cap_" + end);
            if (side == "back") continue;  // the casing is symmetric
            near.emplace_back("bearing_" + end, "casing_upper");
            near.emplace_back("bearing_" + end, "casing_lower");
            near.emplace_back("cap_" + end, "casing_upper");
            near.emplace_back("cap_" + end, "casing_lower");
            near.emplace_back("cap_" + end + "_screw_1", "casing_upper");
        }
    for (const auto& [a, b] : near) {
        CAPTURE(a);
        CAPTURE(b);
        CHECK(common_volume(part(a), part(b)) < 0.5);  // mm3
    }
    // Plain cylinders replace the bolts, because their threads do not affect clearance.
    for (const JointLayout& j : joints) {
        const double t = thickness(j);
        const TopoDS_Shape shank =
            BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(j.x, j.y, -t), gp_Dir(0, 0, 1)), 8.0, 2.0 * t).Shape();
        for (const char* half : {"casing_upper", "casing_lower"})
            CHECK(common_volume(shank, part(half)) < 1e-6);
    }
}

TEST_CASE("Reducer: the overlap check finds a cylinder that is too thick for its hole") {
    const TopoDS_Shape thick =
        BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(joints[0].x, joints[0].y, 10), gp_Dir(0, 0, 1)), 9.0, 20.0)
            .Shape();
    CHECK(common_volume(thick, part("casing_upper")) > 100.0);
}
