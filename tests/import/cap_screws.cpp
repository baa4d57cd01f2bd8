// Cap screws with a hexagonal socket (ISO 4762) in tapped holes and with nuts: found by their geometry,
// drafted with a key or a bit, accepted by the checks of the model, and tightened by a simulated trainee.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <filesystem>
#include <gp_Ax2.hxx>
#include <nlohmann/json.hpp>

#include "support.hpp"

using namespace import_test;
using nlohmann::json;

namespace {

// The dimensions of a cap screw, mm; ISO 4762 has d_k, k, s and t for them.
struct Screw {
    double d = 6.0, head = 10.0, height = 6.0, socket = 5.0, depth = 3.0, length = 30.0;
};

constexpr Screw m8{8.0, 13.0, 8.0, 6.0, 4.0, 30.0};
constexpr Screw m8_long{8.0, 13.0, 8.0, 6.0, 4.0, 35.0};
constexpr Screw m12{12.0, 18.0, 12.0, 10.0, 6.0, 40.0};

TopoDS_Shape shape_of(const Screw& s) {
    return cap_screw(s.d, s.head, s.height, s.socket, s.depth, s.length);
}

TopoDS_Shape drilled_block(double thickness, double hole, double from) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-40.0, -30.0, 0.0), 80.0, 60.0, thickness).Shape();
    const gp_Ax2 axis(gp_Pnt(0.0, 0.0, from), gp_Dir(0.0, 0.0, 1.0));
    return BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(axis, 0.5 * hole, thickness - from).Shape()).Shape();
}

gp_Trsf over() {
    gp_Trsf turn;
    turn.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0)), pi);
    return turn;
}

// A cover of 12 mm on a block of 40 mm, and the screw with its head up, in a blind hole of the core diameter.
// With a nut the hole goes through the block, which is 10 mm thick then. Millimetres, Z up.
struct CapCover {
    Screw screw;
    double core = 5.0, nut = 0.0;  // nut: its width across flats; 0: none
};

void write_cap(const CapCover& c, const TopoDS_Shape& screw, const std::filesystem::path& file) {
    StepMaker maker;
    const TDF_Label root = maker.assembly("cover");
    const double base = c.nut > 0.0 ? 10.0 : 40.0, clearance = 1.1 * c.screw.d;
    maker.place(root,
                maker.part("housing",
                           c.nut > 0.0 ? drilled_block(base, clearance, 0.0)
                                       : drilled_block(base, c.core, base - 32.0),
                           "#2F5D62"),
                "housing");
    maker.place(root, maker.part("lid", drilled_block(12.0, clearance, 0.0), "#C4C6C8"), "lid",
                moved(0.0, 0.0, base));
    maker.place(root, maker.part("screw", screw, "#D5D9DC"), "screw", moved(0.0, 0.0, base + 12.0) * over());
    if (c.nut > 0.0)
        maker.place(root, maker.part("nut", hexagon_nut(c.nut, 0.8 * c.screw.d, c.core), "#D5D9DC"), "nut",
                    moved(0.0, 0.0, -0.8 * c.screw.d));
    maker.write(file);
}

ImportedLesson import_screw(const CapCover& cover, const TopoDS_Shape& screw) {
    return import_lesson([&](const std::filesystem::path& step) { write_cap(cover, screw, step); });
}

ImportedLesson import_cap(const CapCover& cover) { return import_screw(cover, shape_of(cover.screw)); }

}  // namespace

TEST_CASE("Cap screws: one in a tapped hole is found, drafted with a key, and accepted") {
    const ImportedLesson found = import_cap({m8, 6.647});
    require_one_good_joint(found);
    CHECK(found.draft["joints"][0]["position_mm"] == json({0, 52, 0}));
    const json& type = found.draft["joint_types"]["M8x30 socket head"];
    CHECK(type["form"] == "tapped_hole");
    CHECK(type["head"] == "socket");
    CHECK_FALSE(type.contains("turned"));
    CHECK_FALSE(type.contains("tool"));
    CHECK(type["size"] == "M8");
    CHECK(type["bolt_length_mm"] == 30.0);
    CHECK(found.draft["tool"] == json({{"kind", "hex_key"}, {"size_mm", 6}, {"handle_length_mm", 86}}));
    CHECK_FALSE(found.draft.contains("more_tools"));
    CHECK(found.draft["lesson"]["en"].get<std::string>().find("run the screw down") != std::string::npos);
    REQUIRE(found.report.joint_types.size() == 1);
    CHECK(found.report.joint_types[0].find("joint J1, cap screw in a tapped hole") != std::string::npos);
    CHECK(found.report.tools.at(0).starts_with("a hexagon key of 6 mm"));
}

TEST_CASE("Cap screws: above M8 the draft has a ratchet with a bit") {
    const ImportedLesson found = import_cap({m12, 10.106});
    require_one_good_joint(found);
    CHECK(found.draft["tool"] ==
          json({{"kind", "ratchet"}, {"head", "hex_bit"}, {"size_mm", 10}, {"handle_length_mm", 180}}));
}

TEST_CASE("Cap screws: one with a nut is turned at its head") {
    const ImportedLesson found = import_cap({m8_long, 6.647, 13.0});
    require_one_good_joint(found);
    CHECK(found.draft["joints"][0]["position_mm"] == json({0, 22, 0}));
    const json& type = found.draft["joint_types"].front();
    CHECK_FALSE(type.contains("form"));
    CHECK(type["head"] == "socket");
    CHECK(type["turned"] == "head");
    CHECK(type["members"] == json({{{"thickness_mm", 12}, {"material", "steel"}},
                                   {{"thickness_mm", 10}, {"material", "cast_iron"}}}));
    CHECK(found.report.joint_types.at(0).find("cap screw with a nut") != std::string::npos);
    // Nuts of DIN 934 fit too.
    const Screw m10{10.0, 16.0, 10.0, 8.0, 5.0, 35.0};
    CHECK(import_cap({m10, 8.376, 17.0}).draft["joints"].size() == 1);
}

TEST_CASE("Cap screws: every size of the table from M5 to M24 is found") {
    const Screw sizes[] = {{5, 8.5, 5, 4, 2.5, 25},
                           {6, 10, 6, 5, 3, 25},
                           m8,
                           {10, 16, 10, 8, 5, 30},
                           m12,
                           {16, 24, 16, 14, 8, 40},
                           {20, 30, 20, 17, 10, 40},
                           {24, 36, 24, 19, 12, 40}};
    for (const Screw& size : sizes) {
        CAPTURE(size.d);
        const ImportedLesson found = import_cap({size, 0.85 * size.d});
        REQUIRE(found.draft["joints"].size() == 1);
        CHECK(found.draft["joint_types"].front()["size"] == "M" + std::to_string(static_cast<int>(size.d)));
        CHECK(found.draft["tool"]["size_mm"] == size.socket);
    }
}

TEST_CASE("Cap screws: a chamfered socket with a drilled end, and a chamfered head, change nothing") {
    TopoDS_Shape screw = shape_of(m8);
    // A cone at the mouth of the socket, the tip of the drill at its end, and a chamfer around the head.
    const gp_Ax2 top(gp_Pnt(0.0, 0.0, -8.0), gp_Dir(0.0, 0.0, 1.0)),
        end(gp_Pnt(0.0, 0.0, -4.0), gp_Dir(0.0, 0.0, 1.0));
    screw = BRepAlgoAPI_Cut(screw, BRepPrimAPI_MakeCone(top, 3.6, 2.9, 0.7).Shape()).Shape();
    screw = BRepAlgoAPI_Cut(screw, BRepPrimAPI_MakeCone(end, 2.9, 0.0, 1.6).Shape()).Shape();
    const TopoDS_Shape ring = BRepAlgoAPI_Cut(BRepPrimAPI_MakeCylinder(top, 8.0, 0.8).Shape(),
                                              BRepPrimAPI_MakeCone(top, 5.7, 6.5, 0.8).Shape())
                                  .Shape();
    screw = BRepAlgoAPI_Cut(screw, ring).Shape();
    require_one_good_joint(import_screw({m8, 6.647}, screw));
}

TEST_CASE("Cap screws: a low head, a wrong socket or a missing head is explained") {
    Screw low = m8;
    low.height = 5.0;
    low.socket = 5.0;
    low.depth = 3.8;
    const ImportedLesson din = import_cap({low, 6.647});
    CHECK(din.draft.is_null());
    CHECK(din.has_remark(
        "screw: looks like a cap screw (cylinder 8.00 mm, socket 5.00 mm across flats and 3.80 mm "
        "deep, head 13.00 mm wide and 5.00 mm high), but no cap screw of ISO 4762 has all of "
        "them; expected M8 with a cylinder 7.65 to 8.35 mm wide, a socket of 6 mm, at least 4 mm "
        "deep, and a head 13 mm wide and 8 mm high (it has the low head of DIN 7984"));
    Screw shallow = m8;
    shallow.depth = 2.0;
    CHECK(import_cap({shallow, 6.647}).has_remark("2.00 mm deep"));
    Screw m14{14.0, 21.0, 14.0, 12.0, 7.0, 40.0};
    CHECK(import_cap({m14, 11.835}).has_remark("the table of cap screws has no M14"));
    Screw pin = m8;
    pin.head = 8.0;
    pin.height = 4.4;
    pin.depth = 2.5;
    const ImportedLesson set = import_screw({pin, 6.647}, shape_of(pin));
    CHECK(set.has_remark("has a hexagonal socket of 6.00 mm, but no flat bearing face under a head"));
}

TEST_CASE("Cap screws: a part with a hexagonal pocket is no fastener, and gives no remark") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("cover");
    Screw wide = m8;
    wide.head = 60.0;
    maker.place(root, maker.part("hub", shape_of(wide), "#C4C6C8"), "hub");
    maker.write(folder / "hub.step");
    const auto imported = import(folder / "hub.step", folder / "out");
    REQUIRE(imported.ok());
    REQUIRE(imported.report.remarks.size() == 1);
    CHECK(imported.report.remarks[0].starts_with("no part resembles a bolt or a nut"));
}

TEST_CASE("Cap screws: the programs make lessons of the files, which a simulated trainee finishes") {
    for (const CapCover& cover :
         {CapCover{m8, 6.647}, CapCover{m8_long, 6.647, 13.0}, CapCover{m12, 10.106}}) {
        CAPTURE(cover.screw.d);
        CAPTURE(cover.nut);
        const Folder folder;
        write_cap(cover, shape_of(cover.screw), folder / "cover.step");
        run_program(folder, "bolt-author", "import-step cover.step -o cover");
        CHECK(bytes(folder / "log").find("socket head: joint J1, cap screw") != std::string::npos);
        run_program(folder, "bolt-author", "validate cover --pictures pictures");
        CHECK(bytes(folder / "log").find("hexagon key yet") == std::string::npos);
        run_program(folder, "boltwright", "train cover --headless --quiet --operator expert --out lesson");
        const json summary = json::parse(bytes(folder / "lesson" / "summary.json"));
        CHECK(summary["finished"] == true);
        CHECK(summary["obstacles"] == true);
        CHECK(summary["joints"][0]["verdict"] == "OK");
        run_program(folder, "boltwright", "replay lesson/session.boltwright");
    }
}
