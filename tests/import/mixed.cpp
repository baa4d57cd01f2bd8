// Fasteners of several sizes in one file: each joint type gets the tool of its size.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <gp_Ax2.hxx>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "content/format/assembly.hpp"
#include "support.hpp"
#include "tools/author/geometry/check.hpp"

using namespace import_test;
using nlohmann::json;

namespace {

struct Place {
    double x = 0.0, y = 0.0;  // mm
};

// A box of this size, mm, whose lower face is at z = 0, with round holes from `bottom` upwards.
class Board {
  public:
    Board(double width, double depth, double thickness)
        : shape_(BRepPrimAPI_MakeBox(gp_Pnt(0.0, 0.0, 0.0), width, depth, thickness).Shape()),
          thickness_(thickness) {}
    void drill(const Place& at, double diameter, double bottom = -1.0) {
        const gp_Ax2 axis(gp_Pnt(at.x, at.y, bottom), gp_Dir(0.0, 0.0, 1.0));
        drills_.Append(BRepPrimAPI_MakeCylinder(axis, 0.5 * diameter, thickness_ + 1.0 - bottom).Shape());
    }
    TopoDS_Shape shape() {
        if (drills_.IsEmpty()) return shape_;
        TopTools_ListOfShape boards;
        boards.Append(shape_);
        BRepAlgoAPI_Cut cut;
        cut.SetArguments(boards);
        cut.SetTools(drills_);
        cut.Build();
        return cut.Shape();
    }

  private:
    TopoDS_Shape shape_;
    double thickness_;
    TopTools_ListOfShape drills_;
};

gp_Trsf upside_down(const Place& at, double z) {
    gp_Trsf turn;
    turn.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0)), pi);
    return moved(at.x, at.y, z) * turn;
}

// A lid of 12 mm on a housing of 30 mm that stands out beyond it by a rim of 12 mm. Bolts M8x35 with nuts on
// the rim, screws M10x30 and M6x25 with their heads on the lid.
struct Counts {
    int bolts = 4, screws = 2, caps = 3;
};

constexpr double spacing = 40.0, rim = 12.0, housing = 30.0, lid = 12.0;

void write_mixed(const Counts& counts, const std::filesystem::path& file) {
    const int most = std::max({counts.bolts, counts.screws, counts.caps});
    const double width = spacing * (most + 1);
    Board top(width, 160.0, lid), bottom(width, 110.0, housing), strip(width, 40.0, rim);
    StepMaker maker;
    const TDF_Label root = maker.assembly("mixed");
    const TDF_Label bolt = maker.part("hex bolt", hexagon_bolt(8.0, 13.0, 5.3, 35.0), "#D5D9DC");
    const TDF_Label nut = maker.part("hex nut", hexagon_nut(13.0, 6.8, 6.647), "#D5D9DC");
    const TDF_Label screw = maker.part("hex screw", hexagon_bolt(10.0, 16.0, 6.4, 30.0), "#D5D9DC");
    const TDF_Label cap = maker.part("cap screw", cap_screw(6.0, 10.0, 6.0, 5.0, 3.0, 25.0), "#D5D9DC");
    // The strip lies under the lid, in front of the housing.
    for (int i = 0; i < counts.bolts; ++i) {
        const Place at{spacing * (i + 1), 20.0};
        top.drill(at, 9.0);
        strip.drill(at, 9.0);
        maker.place(root, bolt, "bolt " + std::to_string(i), moved(at.x, at.y, housing - rim));
        maker.place(root, nut, "nut " + std::to_string(i), moved(at.x, at.y, housing + lid));
    }
    for (int i = 0; i < counts.screws; ++i) {
        const Place at{spacing * (i + 1), 80.0};
        top.drill(at, 11.0);
        bottom.drill({at.x, at.y - 50.0}, 8.376, 6.0);
        maker.place(root, screw, "screw " + std::to_string(i), upside_down(at, housing + lid));
    }
    for (int i = 0; i < counts.caps; ++i) {
        const Place at{spacing * (i + 1), 130.0};
        top.drill(at, 6.6);
        bottom.drill({at.x, at.y - 50.0}, 4.917, 10.0);
        maker.place(root, cap, "cap " + std::to_string(i), upside_down(at, housing + lid));
    }
    maker.place(root, maker.part("lid", top.shape(), "#C4C6C8"), "lid", moved(0.0, 0.0, housing));
    maker.place(root, maker.part("housing", bottom.shape(), "#2F5D62"), "housing", moved(0.0, 50.0, 0.0));
    maker.place(root, maker.part("strip", strip.shape(), "#2F5D62"), "strip", moved(0.0, 0.0, housing - rim));
    // A bolt without a nut.
    const TDF_Label lonely = maker.part("lonely", hexagon_bolt(8.0, 13.0, 5.3, 20.0));
    maker.place(root, lonely, "lonely", moved(-100.0, 0.0, 0.0));
    maker.write(file);
}

bool has_line(const std::vector<std::string>& lines, const std::string& text) {
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(text) != std::string::npos; });
}

}  // namespace

TEST_CASE("Mixed sizes: each joint type gets the tool of its size, the most frequent one first") {
    const Folder folder;
    write_mixed({}, folder / "mixed.step");
    const auto imported = import(folder / "mixed.step", folder / "out");
    REQUIRE(imported.ok());
    const step_import::ImportReport& report = imported.report;
    CHECK(report.joints == 9);
    CHECK(report.joints_drafted == 9);
    const auto loaded = content::load_assembly(folder / "out");
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    for (const Error& error : geometry::check_geometry(loaded.assembly).errors) FAIL_CHECK(error.message());
    const json draft = json::parse(bytes(folder / "out" / "assembly.json"));
    CHECK(draft["tool"]["kind"] == "open_end_wrench");
    CHECK(draft["tool"]["jaw_mm"] == 13.2);
    CHECK(draft["more_tools"].size() == 2);
    CHECK(draft["more_tools"]["open_end_16"]["jaw_mm"] == 16.2);
    CHECK(draft["more_tools"]["hex_key_5"]["size_mm"] == 5);
    CHECK_FALSE(draft["joint_types"]["M8x35"].contains("tool"));
    CHECK(draft["joint_types"]["M10x30"]["tool"] == "open_end_16");
    CHECK(draft["joint_types"]["M6x25 socket head"]["tool"] == "hex_key_5");
    // A pass uses one tool after the other.
    std::vector<std::string> tools;
    for (const json& id : draft["order"])
        for (const json& joint : draft["joints"])
            if (joint["id"] == id) {
                const json& type = draft["joint_types"][joint["type"].get<std::string>()];
                const std::string tool = type.value("tool", "");
                if (tools.empty() || tools.back() != tool) tools.push_back(tool);
            }
    CHECK(tools == std::vector<std::string>{"", "hex_key_5", "open_end_16"});
    CHECK(draft["lesson"]["en"].get<std::string>().find("all 9 nuts and screws") != std::string::npos);
    // The summary names tools, assumptions and the bolt without a joint.
    REQUIRE(report.tools.size() == 3);
    CHECK(report.tools[0].starts_with("an open-end wrench of 13 mm"));
    CHECK(has_line(report.tools, "hex_key_5, a hexagon key of 5 mm"));
    CHECK(has_line(report.joint_types,
                   "M10x30: 2 joints, screw in a tapped hole, turned with open_end_16; assumed: class 8.8, "
                   "friction 0.12, target "));
    CHECK(has_line(report.joint_types,
                   "M6x25 socket head: 3 joints, cap screw in a tapped hole, turned with "
                   "hex_key_5; assumed: class 8.8"));
    CHECK(has_line(report.remarks,
                   "lonely: looks like a bolt (cylinder 8.00 mm, hexagon 13.00 mm across "
                   "flats), but no nut is coaxial with it"));
}

TEST_CASE("Mixed sizes: the programs make a lesson in which a trainee changes tools and finishes") {
    const Folder folder;
    write_mixed({}, folder / "mixed.step");
    run_program(folder, "bolt-author", "import-step mixed.step -o mixed");
    const std::string log = bytes(folder / "log");
    for (const char* text :
         {"tool: an open-end wrench of 13 mm", "tool: open_end_16, an open-end wrench of 16 mm",
          "tool: hex_key_5, a hexagon key of 5 mm", "joint type M8x35: 4 joints, bolt with a nut",
          "note: lonely: looks like a bolt"}) {
        CAPTURE(text);
        CHECK(log.find(text) != std::string::npos);
    }
    run_program(folder, "bolt-author", "validate mixed");
    run_program(folder, "boltwright",
                "train mixed --headless --quiet --no-pictures --operator expert --out lesson");
    const json summary = json::parse(bytes(folder / "lesson" / "summary.json"));
    CHECK(summary["finished"] == true);
    run_program(folder, "boltwright", "replay lesson/session.boltwright");
}

TEST_CASE("Mixed sizes: a file of 100 joints is imported; the time is printed") {
    const Folder folder;
    write_mixed({40, 30, 30}, folder / "hundred.step");
    const auto start = std::chrono::steady_clock::now();
    const auto imported = import(folder / "hundred.step", folder / "out", {.far_level = true});
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    REQUIRE(imported.ok());
    CHECK(imported.report.joints_drafted == 100);
    MESSAGE("100 joints in " << seconds << " s");
}
