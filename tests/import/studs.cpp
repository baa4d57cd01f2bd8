// Studs with nuts: found by their geometry, drafted with their engagement, and accepted by the checks of the
// model. Rods that are no studs give no joint.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <filesystem>
#include <gp_Ax2.hxx>
#include <nlohmann/json.hpp>

#include "support.hpp"

namespace import_test::studs {

using nlohmann::json;

namespace {

// A block of 40 mm with a hole in its top, a cover of 16 mm on it, and a stud with a washer and a nut.
// Millimetres, Z up.
struct StudScene {
    double hole = 10.106;       // of the block; the core of M12
    double hole_depth = 24.0;   // of the block
    double engagement = 15.0;   // of the stud in the block
    double length = 50.0;       // of the stud
    double diameter = 12.0;     // of the stud
    double shank = 0.0;         // diameter between its threads; 0: as thick as they are
    double nut_flats = 18.0;    // 0: no nut
    bool nut_below = false;     // a second nut under the block
    bool upside_down = false;   // the stud in its own frame
    double turned = 0.0;        // rad, of the whole assembly about X
    const char* name = "stud";  // of the part
};

TopoDS_Shape cylinder(double diameter, double from, double height) {
    return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.0, 0.0, from), gp_Dir(0.0, 0.0, 1.0)), 0.5 * diameter,
                                    height)
        .Shape();
}

TopoDS_Shape block(double thickness, double hole, double from) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-40.0, -30.0, 0.0), 80.0, 60.0, thickness).Shape();
    return BRepAlgoAPI_Cut(box, cylinder(hole, from, thickness - from)).Shape();
}

TopoDS_Shape stud(const StudScene& s) {
    if (s.shank == 0.0) return cylinder(s.diameter, 0.0, s.length);
    const TopoDS_Shape ends =
        BRepAlgoAPI_Fuse(cylinder(s.diameter, 0.0, s.engagement), cylinder(s.diameter, s.length - 20.0, 20.0))
            .Shape();
    return BRepAlgoAPI_Fuse(ends, cylinder(s.shank, 0.0, s.length)).Shape();
}

void write_studs(const StudScene& s, const std::filesystem::path& file) {
    StepMaker maker;
    const TDF_Label root = maker.assembly("pump");
    const TDF_Label base = maker.part("housing", block(40.0, s.hole, 40.0 - s.hole_depth), "#2F5D62");
    const TDF_Label cover = maker.part("cover", block(16.0, 13.5, 0.0), "#C4C6C8");
    const TDF_Label rod = maker.part(s.name, stud(s), "#D5D9DC");
    const TDF_Label washer = maker.part("washer", ring(24.0, 13.0, 2.5), "#D5D9DC");
    gp_Trsf all, over;
    all.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0)), s.turned);
    over.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.5 * s.length), gp_Dir(1.0, 0.0, 0.0)), pi);
    maker.place(root, base, "housing", all * moved(0.0, 0.0, 1e-9));
    maker.place(root, cover, "cover", all * moved(0.0, 0.0, 40.0));
    const gp_Trsf in_place = moved(0.0, 0.0, 40.0 - s.engagement);
    maker.place(root, rod, s.name, all * (s.upside_down ? in_place * over : in_place));
    maker.place(root, washer, "washer", all * moved(0.0, 0.0, 56.0));
    if (s.nut_flats > 0.0) {
        const TDF_Label nut = maker.part("nut", hexagon_nut(s.nut_flats, 10.8, 10.106), "#D5D9DC");
        maker.place(root, nut, "nut", all * moved(0.0, 0.0, 58.5));
        if (s.nut_below) maker.place(root, nut, "nut below", all * moved(0.0, 0.0, -10.8));
    }
    maker.write(file);
}

ImportedLesson import_studs(const StudScene& scene) {
    return import_lesson([&](const std::filesystem::path& step) { write_studs(scene, step); });
}

void check_stud(const ImportedLesson& found) {
    require_one_good_joint(found);
    const json& type = found.draft["joint_types"].front();
    CHECK(type["form"] == "stud");
    CHECK(type["tapped_hole"] == json({{"material", "GJL-250"}, {"engagement_mm", 15}}));
    CHECK(type["size"] == "M12");
    CHECK(type["bolt_length_mm"] == 35.0);
    CHECK_FALSE(type.contains("washer_under_head"));
    CHECK(type["washer_under_nut"] == true);
    CHECK(type["members"] == json({{{"thickness_mm", 16}, {"material", "steel"}}}));
}

}  // namespace

TEST_CASE("Studs: one in a tapped hole with a nut is found, drafted and accepted") {
    const ImportedLesson found = import_studs({});
    check_stud(found);
    CHECK(found.draft["joint_types"].contains("M12x35 stud"));
    CHECK(found.draft["joints"][0]["position_mm"] == json({0, 56, 0}));
    CHECK_FALSE(found.draft["joints"][0].contains("axis"));
}

TEST_CASE("Studs: the direction of the part, a thinner shank and the pose of the assembly change nothing") {
    check_stud(import_studs({.upside_down = true}));
    check_stud(import_studs({.shank = 10.2}));
    for (const double turned : {0.5 * pi, pi}) {
        CAPTURE(turned);
        const ImportedLesson found = import_studs({.turned = turned});
        check_stud(found);
        REQUIRE(found.draft["joints"].size() == 1);
        // Scene frame: Y up, −Z is the Y axis of CAD.
        CHECK(found.draft["joints"][0]["axis"] == (turned > 3.0 ? json({0, -1, 0}) : json({0, 0, 1})));
    }
}

TEST_CASE("Studs: a hole through the part limits the engagement, and a short one lowers the target") {
    const ImportedLesson through = import_studs({.hole_depth = 40.0, .engagement = 45.0, .length = 80.0});
    REQUIRE(through.draft["joints"].size() == 1);
    CHECK(through.draft["joint_types"].front()["tapped_hole"]["engagement_mm"] == 40.0);
    const auto target = [](const ImportedLesson& found) {
        return found.draft["joint_types"].front()["spec"]["target_torque_Nm"].get<double>();
    };
    CHECK(target(import_studs({.engagement = 7.0, .length = 42.0})) < 0.6 * target(through));
}

TEST_CASE(
    "Studs: a rod that is no stud is explained if it has a nut or the name of a fastener, else ignored") {
    const ImportedLesson two_nuts = import_studs(
        {.hole = 13.5, .hole_depth = 40.0, .engagement = 55.0, .length = 90.0, .nut_below = true});
    CHECK(two_nuts.draft.is_null());
    CHECK(two_nuts.has_remark(
        "stud: looks like a stud (rod 12.00 mm thick and 90.00 mm long), but its end "
        "without the nut nut is in no tapped hole; expected a hole as wide as its thread"));
    CHECK(two_nuts.has_remark("A rod with a nut at each end is no joint form"));
    const ImportedLesson bare = import_studs({.nut_flats = 0.0});
    CHECK(bare.draft.is_null());
    CHECK(bare.has_remark(
        "stud: looks like a stud (rod 12.00 mm thick and 50.00 mm long), but no nut is on it"));
    const ImportedLesson pin = import_studs({.nut_flats = 0.0, .name = "Passstift"});
    CHECK(pin.draft.is_null());
    CHECK_FALSE(pin.has_remark("Passstift"));
    const ImportedLesson odd = import_studs({.nut_flats = 24.0});  // a nut of M16
    CHECK(odd.draft.is_null());
    CHECK(odd.has_remark("no nut is on it"));
    const ImportedLesson collar = import_studs({.shank = 16.0});
    CHECK(collar.draft.is_null());
    CHECK_FALSE(import_studs({.diameter = 10.9}).has_remark("looks like a stud"));  // between M10 and M12
}

TEST_CASE("Studs: the programs make a lesson of the file, in which a simulated trainee tightens the nut") {
    const Folder folder;
    write_studs({}, folder / "pump.step");
    const auto run = [&](const std::string& program, const std::string& arguments) {
        run_program(folder, program, arguments);
    };
    run("bolt-author", "import-step pump.step -o pump");
    CHECK(bytes(folder / "log").find("joint type M12x35 stud: joint J1, stud with a nut, turned with") !=
          std::string::npos);
    run("bolt-author", "validate pump");
    run("boltwright", "train pump --headless --quiet --no-pictures --out lesson");
    const json summary = json::parse(bytes(folder / "lesson" / "summary.json"));
    CHECK(summary["finished"] == true);
    CHECK(summary["obstacles"] == true);
    CHECK(summary["joints"][0]["verdict"] == "OK");
}

}  // namespace import_test::studs
