// Hexagon bolts with a nut that are turned at their heads, because no tool reaches the nut.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <filesystem>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <nlohmann/json.hpp>

#include "support.hpp"

namespace import_test::heads {

using nlohmann::json;

namespace {

// A block 40 mm high with an M8x40 bolt from above. Its nut is in a pocket below, 16 mm wide and 10 mm deep,
// in which no tool finds room. Millimetres, Z up.
struct PocketScene {
    double pocket = 16.0;  // its diameter
    bool grouped = false;  // the fasteners are in a sub-assembly joint_K1 on the seat of the head
};

TopoDS_Shape block(const PocketScene& s) {
    const auto hole = [](double diameter, double height) {
        return BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0)), 0.5 * diameter,
                                        height)
            .Shape();
    };
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-40.0, -30.0, 0.0), 80.0, 60.0, 40.0).Shape();
    return BRepAlgoAPI_Cut(BRepAlgoAPI_Cut(box, hole(9.0, 40.0)).Shape(), hole(s.pocket, 10.0)).Shape();
}

void write_pocket(const PocketScene& s, const std::filesystem::path& file) {
    StepMaker maker;
    const TDF_Label root = maker.assembly("clamp");
    maker.place(root, maker.part("block", block(s), "#2F5D62"), "block");
    gp_Trsf over;
    over.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0)), pi);
    const gp_Trsf head_seat = moved(0.0, 0.0, 40.0);
    const TDF_Label group = s.grouped ? maker.assembly("joint_K1") : root;
    const gp_Trsf in_group = s.grouped ? head_seat.Inverted() : gp_Trsf();
    maker.place(group, maker.part("bolt", hexagon_bolt(8.0, 13.0, 5.3, 40.0), "#7A7F85"), "bolt",
                in_group * head_seat * over);
    maker.place(group, maker.part("nut", hexagon_nut(13.0, 6.8, 6.647), "#7A7F85"), "nut",
                in_group * moved(0.0, 0.0, 3.2));
    if (s.grouped) maker.place(root, group, "joint_K1", head_seat);
    maker.write(file);
}

ImportedLesson import_pocket(const PocketScene& scene, const std::vector<std::string>& turn_heads) {
    step_import::ImportOptions options;
    options.turn_heads = turn_heads;
    return import_lesson([&](const std::filesystem::path& step) { write_pocket(scene, step); }, options);
}

void check_turned_at_head(const ImportedLesson& found) {
    require_one_good_joint(found);
    CHECK(found.draft["joints"][0]["position_mm"] == json({0, 40, 0}));
    CHECK_FALSE(found.draft["joints"][0].contains("axis"));
    const json& type = found.draft["joint_types"]["M8x40 turned at head"];
    CHECK(type["turned"] == "head");
    CHECK(type["members"] == json::parse(R"([{"thickness_mm": 30, "material": "cast_iron"}])"));
    CHECK_FALSE(type.contains("form"));
}

}  // namespace

TEST_CASE("Heads: a nut that no tool reaches is a finding, and --turn-heads mends it") {
    const ImportedLesson at_nut = import_pocket({}, {});
    REQUIRE(at_nut.findings.errors.size() == 2);  // on its seat, and where it starts
    for (const Error& error : at_nut.findings.errors) {
        CAPTURE(error.message());
        CHECK(error.message().find("0.0 degrees of free swing on the nut") != std::string::npos);
        CHECK(error.message().find("or the head turned instead (bolt-author import-step --turn-heads J1)") !=
              std::string::npos);
    }
    CHECK(at_nut.draft["joints"][0]["position_mm"] == json({0, 10, 0}));
    CHECK(at_nut.draft["joints"][0]["axis"] == json({0, -1, 0}));
    check_turned_at_head(import_pocket({}, {"J1"}));
    check_turned_at_head(import_pocket({}, {"all"}));
}

TEST_CASE("Heads: a sub-assembly on the seat of the head has the same effect") {
    const ImportedLesson found = import_pocket({.grouped = true}, {});
    check_turned_at_head(found);
    CHECK(found.draft["joints"][0]["id"] == "K1");
}

TEST_CASE(
    "Heads: the programs make a lesson, in which a simulated trainee turns the head; wrong ids are told") {
    const Folder folder;
    write_pocket({}, folder / "clamp.step");
    const auto run = [&](const std::string& program, const std::string& arguments) {
        run_program(folder, program, arguments);
    };
    run("bolt-author", "import-step clamp.step -o clamp --turn-heads J1");
    run("bolt-author", "validate clamp");
    run("boltwright", "train clamp --headless --quiet --no-pictures --out lesson");
    const json summary = json::parse(bytes(folder / "lesson" / "summary.json"));
    CHECK(summary["finished"] == true);
    CHECK(summary["joints"][0]["verdict"] == "OK");
    const auto wrong = import(folder / "clamp.step", folder / "other", [] {
        step_import::ImportOptions options;
        options.turn_heads = {"J7"};
        return options;
    }());
    REQUIRE(wrong.errors.size() == 1);
    CHECK(wrong.errors[0].code == ErrorCode::usage);
    CHECK(wrong.errors[0].message().find(
              "no hexagon bolt with a nut is a joint J7; expected one of J1, or all") != std::string::npos);
}

}  // namespace import_test::heads
