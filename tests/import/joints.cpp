// Joints found by geometry alone (size, length, grip, seat, axis, washers, members), and the draft made from
// them.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <cmath>
#include <gp_Ax2.hxx>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "support.hpp"
#include "tools/author/import/joints.hpp"

using namespace import_test;
using nlohmann::json;

namespace {

TopoDS_Shape plate(double x, double y, double thickness, double hole) {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(gp_Pnt(-0.5 * x, -0.5 * y, 0.0), x, y, thickness).Shape();
    return BRepAlgoAPI_Cut(box, BRepPrimAPI_MakeCylinder(0.5 * hole, thickness).Shape()).Shape();
}

// Two plates of 20 and 28 mm from z = 0 upwards and an M16x80 bolt with washers and a nut on top, placed by
// `where`. The seat under the washer of the nut is at z = 48.
struct Stack {
    TDF_Label bolt, nut, washer, lower, upper;
    explicit Stack(StepMaker& maker) {
        bolt = maker.part("hexagon_screw", hexagon_bolt(16.0, 24.0, 10.0, 80.0), "#D5D9DC");
        nut = maker.part("mutter", hexagon_nut(24.0, 14.8, 13.835), "#D5D9DC");
        washer = maker.part("scheibe", ring(30.0, 17.0, 3.0), "#D5D9DC");
        lower = maker.part("lower", plate(80.0, 60.0, 20.0, 17.5), "#2F5D62");
        upper = maker.part("upper", plate(80.0, 60.0, 28.0, 17.5), "#C4C6C8");
    }
    void plates(StepMaker& maker, const TDF_Label& root, const gp_Trsf& where, const std::string& tag) const {
        maker.place(root, lower, "lower" + tag, where);
        maker.place(root, upper, "upper" + tag, where * moved(0.0, 0.0, 20.0));
    }
    void fasteners(StepMaker& maker, const TDF_Label& root, const gp_Trsf& where,
                   const std::string& tag) const {
        maker.place(root, bolt, "screw" + tag, where * moved(0.0, 0.0, -3.0));
        maker.place(root, washer, "w1" + tag, where * moved(0.0, 0.0, -3.0));
        maker.place(root, washer, "w2" + tag, where * moved(0.0, 0.0, 48.0));
        maker.place(root, nut, "nut" + tag, where * moved(0.0, 0.0, 51.0));
    }
};

json draft(const std::filesystem::path& file) {
    const auto loaded = content::load_assembly(file);
    for (const Error& error : loaded.errors) FAIL_CHECK(error.message());
    return json::parse(bytes(file));
}

// A box from y = 0 upwards, m.
step_import::PartMesh box_mesh(double side, double height) {
    step_import::PartMesh mesh;
    step_import::FaceMesh face;
    for (std::uint32_t i = 0; i < 8; ++i) {
        mesh.points.push_back({(i & 1U) != 0 ? 0.5 * side : -0.5 * side, (i & 2U) != 0 ? height : 0.0,
                               (i & 4U) != 0 ? 0.5 * side : -0.5 * side});
        face.points.push_back(i);
    }
    face.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    mesh.faces.push_back(std::move(face));
    return mesh;
}

// Searches for an M16x1.5 joint whose parts are modelled `size` times as large and instanced at the scale
// 1 / `size`. `flats`: across flats of the nut, mm.
step_import::JointSearchResult search_scaled(double size, double flats) {
    using namespace step_import;
    const double m = mm * size;
    const Vec3 up{0.0, 1.0, 0.0};
    std::vector<PartGeometry> parts(4);
    parts[0].fastener = {FastenerKind::bolt, Vec3{0.0}, up, 24.0 * m, 0.0, 80.0 * m, 16.0 * m, {}, {}};
    parts[1].fastener = {FastenerKind::nut, Vec3{0.0}, up, flats * m, 0.0, 14.8 * m, 14.376 * m, {}, {}};
    parts[2].fastener = {FastenerKind::washer, Vec3{0.0}, up, 0.0, 0.0, 3.0 * m, 17.0 * m, {}, {}};
    parts[3].mesh = box_mesh(80.0 * m, 48.0 * m);
    parts[3].holes = {{Vec3{0.0}, up, 8.75 * m}};
    Tree tree;
    const auto add = [&](const char* name, int part, double height) {
        tree.roots.push_back(static_cast<int>(tree.nodes.size()));
        TreeNode node;
        node.name = name;
        node.shape = part;
        node.local = {Quat{1.0, 0.0, 0.0, 0.0}, Vec3{0.0, height * mm, 0.0}, 1.0 / size};
        tree.nodes.push_back(node);
    };
    for (int part = 0; part < 4; ++part) tree.shapes.push_back({part, {}, 1});
    add("bolt", 0, -3.0);
    add("nut", 1, 51.0);
    add("washer_head", 2, -3.0);
    add("washer_nut", 2, 48.0);
    add("plates", 3, 0.0);
    return find_joints(tree, parts);
}

Vec3 vec(const json& list) { return {list[0].get<double>(), list[1].get<double>(), list[2].get<double>()}; }

}  // namespace

TEST_CASE("Import: an M16 bolt with nut, washers and two plates is found exactly") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("plates");
    const Stack stack(maker);
    gp_Trsf turn;
    turn.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 1.0, 0.0)), 0.5 * pi);  // +Z becomes +X
    const gp_Trsf places[] = {moved(0.0, 0.0, 0.0), moved(200.0, 100.0, 50.0), moved(500.0, 7.0, 9.0) * turn};
    for (int i = 0; i < 3; ++i) {
        stack.plates(maker, root, places[i], "_" + std::to_string(i));
        stack.fasteners(maker, root, places[i], "_" + std::to_string(i));
    }
    maker.write(folder / "plates.step");
    const auto imported = import(folder / "plates.step", folder / "out");
    REQUIRE(imported.ok());
    CHECK(imported.report.joints == 3);
    CHECK(imported.report.joints_drafted == 3);
    for (const std::string& remark : imported.report.remarks) FAIL_CHECK(remark);

    const json file = draft(folder / "out" / "assembly.json");
    CHECK(file["model"] == "plates.glb");
    CHECK(file["contact_model"] == "plates.contact.glb");
    REQUIRE(file["joint_types"].size() == 1);
    const json& type = file["joint_types"]["M16x80"];
    CHECK(type["size"] == "M16");
    CHECK(type["bolt_length_mm"] == 80.0);
    CHECK(type["washer_under_head"] == true);
    CHECK(type["washer_under_nut"] == true);
    REQUIRE(type["members"].size() == 2);
    CHECK(type["members"][0] == json({{"thickness_mm", 20}, {"material", "cast_iron"}}));
    CHECK(type["members"][1] == json({{"thickness_mm", 28}, {"material", "steel"}}));

    const assets::Model model = load(folder / "out" / "plates.glb");
    struct Expected {
        const char* id;
        Vec3 seat_mm, axis;  // glTF frame
    };
    const Expected all[] = {{"J1", {0.0, 48.0, 0.0}, {0.0, 1.0, 0.0}},
                            {"J2", {200.0, 98.0, -100.0}, {0.0, 1.0, 0.0}},
                            {"J3", {548.0, 9.0, -7.0}, {1.0, 0.0, 0.0}}};
    REQUIRE(file["joints"].size() == 3);
    for (std::size_t i = 0; i < 3; ++i) {
        const Expected& expected = all[i];
        const json& joint = file["joints"][i];
        CAPTURE(expected.id);
        CHECK(joint["id"] == expected.id);
        CHECK(glm::length(vec(joint["position_mm"]) - expected.seat_mm) < 1e-3);
        const Vec3 axis = joint.contains("axis") ? vec(joint["axis"]) : Vec3{0.0, 1.0, 0.0};
        CHECK(glm::length(axis - expected.axis) < 1e-9);
        // The named node is at the seat and along the axis, with its four fasteners under it.
        const int node = node_named(model, joint["node"]);
        REQUIRE(node >= 0);
        const glm::dmat4 at = world(model, node);
        CHECK(glm::length(Vec3(at[3]) * 1e3 - expected.seat_mm) < 1e-3);
        CHECK(glm::length(Vec3(at[1]) - expected.axis) < 1e-6);
        CHECK(model.nodes[static_cast<std::size_t>(node)].children.size() == 4);
        for (const char* part : {"bolt", "washer_head", "washer_nut", "nut"})
            CHECK(node_named(model, std::string(expected.id) + "_" + part) >= 0);
        // The nut keeps its position.
        const glm::dmat4 nut = world(model, node_named(model, std::string(expected.id) + "_nut"));
        CHECK(glm::length(Vec3(nut[3]) * 1e3 - (expected.seat_mm + 3.0 * expected.axis)) < 1e-3);
    }
}

TEST_CASE("Import: a group joint_ID in the file gives the id and keeps its pose") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("cover");
    const Stack stack(maker);
    const gp_Trsf seat = moved(0.0, 0.0, 48.0);
    for (const char* id : {"joint_B7", "joint_F1"}) {
        const gp_Trsf where = moved(id[6] == 'B' ? 0.0 : 300.0, 0.0, 0.0);
        stack.plates(maker, root, where, id);
        const TDF_Label group = maker.assembly(id);
        stack.fasteners(maker, group, seat.Inverted(), std::string("_") + id);
        maker.place(root, group, id, where * seat);
    }
    maker.write(folder / "cover.step");
    const auto imported = import(folder / "cover.step", folder / "out");
    REQUIRE(imported.ok());
    for (const std::string& remark : imported.report.remarks) FAIL_CHECK(remark);
    const json file = draft(folder / "out" / "assembly.json");
    REQUIRE(file["joints"].size() == 2);
    CHECK(file["joints"][0]["id"] == "B7");
    CHECK(file["joints"][0]["node"] == "joint_B7");
    CHECK(file["joints"][1]["id"] == "F1");
    CHECK(file["joints"][1]["position_mm"] == json({300, 48, 0}));
    const assets::Model model = load(folder / "out" / "cover.glb");
    CHECK(node_named(model, "B7_nut") >= 0);
    CHECK(node_named(model, "F1_washer_nut") >= 0);
}

TEST_CASE("Import: a group whose origin is off the hole gives a remark") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("cover");
    const Stack stack(maker);
    stack.plates(maker, root, {}, "");
    const TDF_Label group = maker.assembly("joint_A");
    stack.fasteners(maker, group, moved(0.0, 0.0, -47.5), "");
    maker.place(root, group, "joint_A", moved(0.0, 0.0, 47.5));
    maker.write(folder / "cover.step");
    const auto imported = import(folder / "cover.step", folder / "out");
    REQUIRE(imported.ok());
    REQUIRE(imported.report.remarks.size() == 1);
    CHECK(imported.report.remarks[0].find("joint_A: its origin is 0.500 mm") != std::string::npos);
    CHECK(draft(folder / "out" / "assembly.json")["joints"][0]["position_mm"] == json({0, 48, 0}));
}

TEST_CASE("Import: bolts and nuts that form no joint give a remark each") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("parts");
    const Stack stack(maker);
    maker.place(root, stack.bolt, "lonely_bolt", moved(0.0, 0.0, 0.5));
    maker.place(root, stack.nut, "beside", moved(1.0, 0.0, 51.0));
    const TDF_Label pin = maker.part("pin", ring(16.0, 5.0, 80.0));
    maker.place(root, pin, "pin", moved(100.0, 0.0, 0.0));
    maker.place(root, stack.nut, "nut_on_pin", moved(100.0, 0.0, 30.0));
    const TDF_Label odd = maker.part("odd", hexagon_bolt(16.0, 20.0, 10.0, 80.0));
    const TDF_Label odd_nut = maker.part("odd_nut", hexagon_nut(20.0, 14.0, 13.8));
    maker.place(root, odd, "odd", moved(200.0, 0.0, 0.0));
    maker.place(root, odd_nut, "odd_nut", moved(200.0, 0.0, 50.0));
    maker.write(folder / "parts.step");
    const auto imported = import(folder / "parts.step", folder / "out");
    REQUIRE(imported.ok());
    CHECK(imported.report.joints == 0);
    CHECK_FALSE(std::filesystem::exists(folder / "out" / "assembly.json"));
    CHECK(node_named(load(folder / "out" / "parts.glb"), "lonely_bolt") >= 0);
    // The first remark is about the missing colour, then each fastener has one with its reason (the odd nut
    // is named in that of its bolt), and the last remark names the next step.
    const std::vector<std::string>& all = imported.report.remarks;
    REQUIRE(!all.empty());
    CHECK(all.front().starts_with("material "));
    const std::vector<std::string> remarks(all.begin() + 1, all.end());
    const char* reasons[] = {
        "lonely_bolt: looks like a bolt (cylinder 16.00 mm, hexagon 24.00 mm across flats), but no nut is "
        "coaxial with it: the nearest one, beside, is 1.00 mm off its axis",
        "odd: looks like a bolt (cylinder 16.00 mm, hexagon 20.00 mm across flats), but no metric size has "
        "both; expected M16 with a cylinder 15.36 to 16.64 mm wide and a hexagon 24 mm across flats",
        "beside: looks like a nut (hole 13.83 mm, hexagon 24.00 mm across flats), but no bolt is paired with "
        "it",
        "nut_on_pin: looks like a nut", "write their joints into assembly.json by hand"};
    REQUIRE(remarks.size() == std::size(reasons));
    for (std::size_t i = 0; i < std::size(reasons); ++i) {
        CAPTURE(remarks[i]);
        CHECK(remarks[i].find(reasons[i]) != std::string::npos);
    }
}

TEST_CASE("Import: the bolt gives the size from M4 to M39, and the hole of the nut gives a fine thread") {
    struct Case {
        const char* size;
        double d, flats, head, nut, hole, length;
    };
    const Case cases[] = {{"M4", 4, 7, 2.8, 3.2, 3.242, 30},         {"M8", 8, 13, 5.3, 6.8, 6.647, 40},
                          {"M8x1", 8, 13, 5.3, 6.8, 6.917, 40},      {"M10", 10, 16, 6.4, 8.4, 8.376, 50},
                          {"M10", 10, 17, 6.4, 8.4, 8.376, 50},      {"M20", 20, 30, 12.5, 18, 17.294, 90},
                          {"M16x1.5", 16, 24, 10, 14.8, 14.376, 90}, {"M39", 39, 60, 25, 33.4, 34.67, 150}};
    for (const Case& one : cases) {
        CAPTURE(one.size);
        CAPTURE(one.flats);
        const Folder folder;
        StepMaker maker;
        const TDF_Label root = maker.assembly("one");
        const double grip = 0.4 * one.length;
        maker.place(root, maker.part("b", hexagon_bolt(one.d, one.flats, one.head, one.length)), "b1");
        maker.place(root, maker.part("n", hexagon_nut(one.flats, one.nut, one.hole)), "n1",
                    moved(0, 0, grip));
        maker.place(root, maker.part("p", plate(200, 200, grip, 1.1 * one.d)), "p1");
        maker.write(folder / "one.step");
        const auto imported = import(folder / "one.step", folder / "out");
        REQUIRE(imported.ok());
        REQUIRE(imported.report.joints == 1);
        const json file = json::parse(bytes(folder / "out" / "assembly.json"));
        const json& type = file["joint_types"].begin().value();
        CHECK(type["size"] == one.size);
        CHECK(type["bolt_length_mm"].get<double>() == doctest::Approx(one.length));
        CHECK(type["members"][0]["thickness_mm"].get<double>() == doctest::Approx(grip));
        CHECK(type["washer_under_nut"] == false);
    }
}

TEST_CASE("Import: a draft never replaces the author's own file") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("plates");
    const Stack stack(maker);
    stack.plates(maker, root, {}, "");
    stack.fasteners(maker, root, {}, "");
    maker.write(folder / "plates.step");
    REQUIRE(import(folder / "plates.step", folder / "out").ok());
    const std::string first = bytes(folder / "out" / "assembly.json");
    REQUIRE(import(folder / "plates.step", folder / "out").ok());  // an identical draft is not written again
    CHECK_FALSE(std::filesystem::exists(folder / "out" / "assembly.draft.json"));
    std::filesystem::resize_file(folder / "out" / "assembly.json", 3);
    REQUIRE(import(folder / "plates.step", folder / "out").ok());
    CHECK(bytes(folder / "out" / "assembly.json").size() == 3);
    CHECK(bytes(folder / "out" / "assembly.draft.json") == first);
}

TEST_CASE("Import: raised faces and the gasket of a flange count as clamped members") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("flanges");
    // Flanges of 18 mm at the bolts with a raised face of 3 mm in the middle; a gasket of 2 mm between them.
    const TopoDS_Shape plain = BRepPrimAPI_MakeCylinder(100.0, 18.0).Shape();
    const TopoDS_Shape face =
        BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(0.0, 0.0, 18.0), gp::DZ()), 50.0, 3.0).Shape();
    TopoDS_Shape flange = BRepAlgoAPI_Fuse(plain, face).Shape();
    for (int i = 0; i < 4; ++i) {
        const gp_Pnt at(75.0 * std::cos(0.5 * pi * i), 75.0 * std::sin(0.5 * pi * i), 0.0);
        flange = BRepAlgoAPI_Cut(flange, BRepPrimAPI_MakeCylinder(gp_Ax2(at, gp::DZ()), 8.75, 18.0).Shape())
                     .Shape();
    }
    const TDF_Label part = maker.part("flange", flange, "#C4C6C8");
    gp_Trsf over;
    over.SetRotation(gp_Ax1(gp_Pnt(0.0, 0.0, 0.0), gp_Dir(1.0, 0.0, 0.0)), pi);
    maker.place(root, part, "lower", moved(1.0, 0.0, 0.0));
    maker.place(root, part, "upper", moved(1.0, 0.0, 44.0) * over);
    maker.place(root, maker.part("gasket", ring(98.0, 40.0, 2.0), "#4A3B2A"), "seal", moved(1.0, 0.0, 21.0));
    const TDF_Label bolt = maker.part("b", hexagon_bolt(16.0, 24.0, 10.0, 70.0));
    const TDF_Label nut = maker.part("n", hexagon_nut(24.0, 14.8, 13.835));
    for (int i = 0; i < 4; ++i) {
        const double x = 1.0 + 75.0 * std::cos(0.5 * pi * i), y = 75.0 * std::sin(0.5 * pi * i);
        maker.place(root, bolt, "b" + std::to_string(i), moved(x, y, 0.0));
        maker.place(root, nut, "n" + std::to_string(i), moved(x, y, 44.0));
    }
    maker.write(folder / "flanges.step");
    const auto imported = import(folder / "flanges.step", folder / "out");
    REQUIRE(imported.ok());
    CHECK(imported.report.joints == 4);
    const json file = draft(folder / "out" / "assembly.json");
    const json& members = file["joint_types"]["M16x70"]["members"];
    REQUIRE(members.size() == 3);
    CHECK(members[0] == json({{"thickness_mm", 21}, {"material", "steel"}}));
    CHECK(members[1] == json({{"thickness_mm", 2}, {"material", "gasket"}}));
    CHECK(members[2] == json({{"thickness_mm", 21}, {"material", "steel"}}));
    // The second of four joints on a circle is opposite to the first.
    const json& order = file["order"];
    const auto place = [&](const json& id) {
        for (const json& joint : file["joints"])
            if (joint["id"] == id) return vec(joint["position_mm"]);
        return Vec3{0.0};
    };
    CHECK(glm::length(place(order[0]) - place(order[1])) == doctest::Approx(150.0));
    CHECK(glm::length(place(order[2]) - place(order[3])) == doctest::Approx(150.0));
}

TEST_CASE("Import: fasteners and members of a scaled instance have their sizes in the assembly") {
    for (const double size : {1.0, 0.5, 2.0, 25.4}) {
        CAPTURE(size);
        const step_import::JointSearchResult found = search_scaled(size, 24.0);
        CHECK(found.remarks.empty());
        REQUIRE(found.joints.size() == 1);
        const step_import::JointCandidate& joint = found.joints.front();
        CHECK(joint.size == "M16x1.5");
        CHECK(joint.bolt_length == doctest::Approx(0.080));
        CHECK(joint.grip == doctest::Approx(0.048));
        CHECK(joint.head_washers.size() == 1);
        CHECK(joint.nut_washers.size() == 1);
        REQUIRE(joint.members.size() == 1);
        CHECK(joint.members[0].node == 4);
        CHECK(joint.members[0].thickness == doctest::Approx(0.048));
        CHECK(search_scaled(size, 27.0).remarks == search_scaled(1.0, 27.0).remarks);
    }
}
