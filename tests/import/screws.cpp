// Hexagon screws in tapped holes: found by their geometry, drafted with their engagement, and accepted by the
// checks of the model.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <algorithm>
#include <filesystem>
#include <gp_Ax2.hxx>
#include <nlohmann/json.hpp>

#include "support.hpp"

using namespace import_test;
using nlohmann::json;

namespace {

// A block of 40 mm with a blind hole in its top, a cover of 16 mm on it, and an M12x40 with a washer whose
// head is on top. Millimetres, Z up.
struct Cover {
    double hole = 10.106;      // of the block; the core of M12
    double hole_depth = 30.0;  // of the block
    double screw = 40.0;       // length under the head
    double cover = 16.0;       // thickness; 0: no cover
    double across_flats = 18.0;
};

void write_cover(const Cover& c, const std::filesystem::path& file) {
    StepMaker maker;
    const TDF_Label root = maker.assembly("pump");
    const auto block = [](double thickness, double hole, double from) {
        const TopoDS_Shape box =
            BRepPrimAPI_MakeBox(gp_Pnt(-40.0, -30.0, 0.0), 80.0, 60.0, thickness).Shape();
        const gp_Ax2 axis(gp_Pnt(0.0, 0.0, from), gp_Dir(0.0, 0.0, 1.0));
        return BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(axis, 0.5 * hole, thickness - from).Shape())
            .Shape();
    };
    const TDF_Label base = maker.part("housing", block(40.0, c.hole, 40.0 - c.hole_depth), "#2F5D62");
    const TDF_Label cover = maker.part("cover", block(std::max(c.cover, 1.0), 13.5, 0.0), "#C4C6C8");
    const TDF_Label screw = maker.part("screw", hexagon_bolt(12.0, c.across_flats, 7.5, c.screw), "#D5D9DC");
    const TDF_Label washer = maker.part("washer", ring(24.0, 13.0, 2.5), "#D5D9DC");
    gp_Trsf over;
    over.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0)), pi);
    maker.place(root, base, "housing");
    if (c.cover > 0.0) maker.place(root, cover, "cover", moved(0.0, 0.0, 40.0));
    maker.place(root, washer, "washer", moved(0.0, 0.0, 40.0 + c.cover));
    maker.place(root, screw, "screw", moved(0.0, 0.0, 42.5 + c.cover) * over);
    maker.write(file);
}

ImportedLesson import_cover(const Cover& cover) {
    return import_lesson([&](const std::filesystem::path& step) { write_cover(cover, step); });
}

}  // namespace

TEST_CASE("Screws: a hexagon screw in a tapped hole is found, drafted and accepted") {
    const ImportedLesson found = import_cover({});
    require_one_good_joint(found);
    CHECK(found.draft["joints"][0]["position_mm"] == json({0, 56, 0}));
    CHECK_FALSE(found.draft["joints"][0].contains("axis"));
    const json& type = found.draft["joint_types"].front();
    CHECK(type["form"] == "tapped_hole");
    CHECK(type["tapped_hole"] == json({{"material", "GJL-250"}}));
    CHECK(type["size"] == "M12");
    CHECK(type["bolt_length_mm"] == 40.0);
    CHECK(type["washer_under_head"] == true);
    CHECK(type["washer_under_nut"] == false);
    CHECK(type["members"] == json({{{"thickness_mm", 16}, {"material", "steel"}}}));
}

TEST_CASE("Screws: the hole shows a fine pitch, and may be as wide as the thread") {
    CHECK(import_cover({.hole = 10.647}).draft["joint_types"].front()["size"] == "M12x1.25");
    CHECK(import_cover({.hole = 12.0}).draft["joint_types"].front()["form"] == "tapped_hole");
}

TEST_CASE("Screws: odd thicknesses give a valid draft, and a hole through the part limits the engagement") {
    CHECK(import_cover({.cover = 16.04}).draft["joints"].size() == 1);
    const ImportedLesson through = import_cover({.hole_depth = 40.0, .screw = 70.0});
    REQUIRE(through.draft["joints"].size() == 1);
    CHECK(through.draft["joint_types"].front()["tapped_hole"]["engagement_mm"] == 40.0);
    const ImportedLesson full = import_cover({.hole_depth = 40.0, .screw = 58.0});
    CHECK(full.draft["joint_types"].front()["bolt_thread_length_mm"] == 58.0);
    for (const ImportedLesson* found : {&through, &full})
        for (const Error& error : found->findings.errors) FAIL_CHECK(error.message());
}

TEST_CASE("Screws: validate reports a screw that is longer than its blind hole") {
    const ImportedLesson deep = import_cover({.screw = 60.0});
    REQUIRE(deep.findings.errors.size() == 1);
    CHECK(
        deep.findings.errors[0].message().find(
            R"("J1_bolt" reaches 41.50 mm behind the members, and the tapped hole in "housing" is 30.00 mm deep)") !=
        std::string::npos);
}

TEST_CASE("Screws: a screw that clamps nothing, or engages too little, is no joint") {
    const ImportedLesson shallow = import_cover({.screw = 23.0, .cover = 16.0});
    REQUIRE_FALSE(shallow.report.remarks.empty());
    CHECK(shallow.draft.is_null());
    const ImportedLesson bare = import_cover({.screw = 25.0, .cover = 0.0});
    REQUIRE_FALSE(bare.report.remarks.empty());
    CHECK(bare.report.remarks[0].find("screw: clamps nothing: 0.00 mm are between its head and housing") !=
          std::string::npos);
    CHECK(bare.draft.is_null());
    const ImportedLesson lost_nut = import_cover({.hole = 12.0, .hole_depth = 40.0, .screw = 80.0});
    CHECK(lost_nut.draft.is_null());
}

TEST_CASE("Screws: a thread that would strip gets a lower target") {
    const double deep = import_cover({}).draft["joint_types"].front()["spec"]["target_torque_Nm"];
    const double shallow =
        import_cover({.screw = 26.0, .cover = 16.0}).draft["joint_types"].front()["spec"]["target_torque_Nm"];
    CHECK(shallow < 0.6 * deep);
}

TEST_CASE("Screws: a screw that no metric size describes, or that ends in a clearance hole, is explained") {
    const ImportedLesson inch = import_cover({.across_flats = 22.0});
    REQUIRE_FALSE(inch.report.remarks.empty());
    CHECK(inch.report.remarks[0].find("no metric size has both") != std::string::npos);
    const ImportedLesson loose = import_cover({.hole = 13.5});
    REQUIRE_FALSE(loose.report.remarks.empty());
    CHECK(loose.report.remarks[0].find("no part has a tapped hole around its end") != std::string::npos);
}

TEST_CASE("Screws: the programs make a lesson of the file, in which a simulated trainee tightens the screw") {
    const Folder folder;
    write_cover({}, folder / "pump.step");
    const auto run = [&](const std::string& program, const std::string& arguments) {
        run_program(folder, program, arguments);
    };
    run("bolt-author", "import-step pump.step -o pump");
    run("bolt-author", "validate pump --pictures pictures");
    CHECK(bytes(folder / "log").find("pictures/J1.png: 360.0 degrees of free swing") != std::string::npos);
    CHECK(std::filesystem::file_size(folder / "pictures" / "J1.png") > 10'000);
    run("boltwright", "train pump --headless --quiet --no-pictures --out lesson");
    const json summary = json::parse(bytes(folder / "lesson" / "summary.json"));
    CHECK(summary["finished"] == true);
    CHECK(summary["obstacles"] == true);
    CHECK(summary["joints"][0]["verdict"] == "OK");
    run("boltwright", "export lesson/session.boltwright --csv ticks.csv --every 100");
    CHECK(bytes(folder / "ticks.csv").find("J1") != std::string::npos);
    // The session and the report name the screw.
    const std::string session = bytes(folder / "lesson" / "session.boltwright");
    CHECK(session.find("wrench on the screw") != std::string::npos);
    CHECK(session.find("wrench on the nut") == std::string::npos);
    const std::string report = bytes(folder / "lesson" / "report.html");
    CHECK(report.find("Time to get onto the screw") != std::string::npos);
    CHECK(report.find("torque and clamp force over the screw angle") != std::string::npos);
    CHECK(report.find(" nut") == std::string::npos);
    run("boltwright", "replay lesson/session.boltwright");
}
