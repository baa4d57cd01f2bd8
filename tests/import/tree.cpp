// The tree of an assembly after the import: names, instances, placements and colours.
#include <doctest/doctest.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <cmath>
#include <gp_Ax1.hxx>
#include <set>

#include "support.hpp"

using namespace import_test;

namespace {

std::string material_of(const assets::Model& model, const std::string& node) {
    const int index = node_named(model, node);
    if (index < 0) return "no such node";
    const int mesh = model.nodes[static_cast<std::size_t>(index)].mesh;
    if (mesh < 0) return "no mesh";
    const auto& primitives = model.meshes[static_cast<std::size_t>(mesh)].primitives;
    if (primitives.size() != 1) return "several";
    return model.materials[static_cast<std::size_t>(primitives[0].material)].name;
}

}  // namespace

TEST_CASE("Import: a part used twelve times gives one mesh and twelve nodes at their places") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("rack");
    const TDF_Label peg = maker.part("peg", BRepPrimAPI_MakeCylinder(5.0, 20.0).Shape(), "#C4C6C8");
    for (int i = 0; i < 12; ++i)
        maker.place(root, peg, "peg_" + std::to_string(i), moved(10.0 * i, 5.0, 2.0 * i));
    maker.write(folder / "rack.step");
    const auto imported = import(folder / "rack.step", folder / "out");
    REQUIRE(imported.ok());
    CHECK(imported.report.instances == 12);
    CHECK(imported.report.renamed == 0);
    REQUIRE(imported.report.parts.size() == 1);
    CHECK(imported.report.parts[0].name == "peg");
    CHECK(imported.report.triangles == 12 * imported.report.parts[0].triangles);
    for (const char* file : {"rack.glb", "rack.contact.glb"}) {
        const assets::Model model = load(folder / "out" / file);
        CHECK(model.meshes.size() == 1);
        CHECK(model.nodes.size() == 13);
        REQUIRE(model.roots.size() == 1);
        CHECK(model.nodes[static_cast<std::size_t>(model.roots[0])].name == "rack");
        for (int i = 0; i < 12; ++i) {
            const int node = node_named(model, "peg_" + std::to_string(i));
            REQUIRE(node >= 0);
            const assets::Node& at = model.nodes[static_cast<std::size_t>(node)];
            CHECK(at.mesh == 0);
            CHECK(at.rotation == glm::quat(1.0F, 0.0F, 0.0F, 0.0F));
            CHECK(at.scale == glm::vec3(1.0F));
            CHECK(glm::length(at.translation - glm::vec3(0.010 * i, 0.002 * i, -0.005)) < 1e-7F);
        }
    }
}

TEST_CASE("Import: rotated sub-assemblies keep every corner, and local +Z becomes local +Y") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("root");
    const TDF_Label group = maker.assembly("arm");
    const TDF_Label box = maker.part("box", BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape());
    gp_Trsf inner, outer, tilt;
    inner.SetRotation(gp_Ax1(gp_Pnt(1.0, 2.0, 3.0), gp_Dir(1.0, 1.0, 0.0)), 0.7);
    outer.SetRotation(gp_Ax1(gp_Pnt(-4.0, 0.0, 9.0), gp_Dir(0.0, 1.0, 2.0)), -1.9);
    tilt.SetTranslation(gp_Vec(100.0, -50.0, 25.0));
    outer = tilt * outer;
    maker.place(group, box, "box_in_arm", inner);
    maker.place(root, group, "arm_1", outer);
    maker.write(folder / "turned.step");
    REQUIRE(import(folder / "turned.step", folder / "out").ok());
    const assets::Model model = load(folder / "out" / "turned.glb");
    CHECK(node_named(model, "arm_1") >= 0);
    const int node = node_named(model, "box_in_arm");
    REQUIRE(node >= 0);
    const glm::dmat4 matrix = world(model, node);
    for (const gp_Pnt& corner : {gp_Pnt(0, 0, 0), gp_Pnt(10, 0, 0), gp_Pnt(0, 20, 0), gp_Pnt(10, 20, 30)}) {
        const gp_Pnt expected = corner.Transformed(outer * inner);
        const glm::dvec4 actual =
            matrix * glm::dvec4(corner.X() * 1e-3, corner.Z() * 1e-3, -corner.Y() * 1e-3, 1.0);
        CHECK(actual.x * 1e3 == doctest::Approx(expected.X()).epsilon(1e-5));
        CHECK(actual.y * 1e3 == doctest::Approx(expected.Z()).epsilon(1e-5));
        CHECK(actual.z * 1e3 == doctest::Approx(-expected.Y()).epsilon(1e-5));
    }
    const gp_Dir up = gp_Dir(0.0, 0.0, 1.0).Transformed(outer);
    const glm::dvec4 y = world(model, node_named(model, "arm_1")) * glm::dvec4(0.0, 1.0, 0.0, 0.0);
    CHECK(std::abs(y.x - up.X()) + std::abs(y.y - up.Z()) + std::abs(y.z + up.Y()) < 1e-6);
}

TEST_CASE("Import: names in several languages survive, and a duplicate name gets a reproducible number") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("Gehäuse 减速器");
    const TDF_Label a = maker.part("Deckel", BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape());
    const TDF_Label b = maker.part("Boden", BRepPrimAPI_MakeBox(2.0, 2.0, 3.0).Shape());
    maker.place(root, a, "Flansch Ø20", moved(1.0, 0.0, 0.0));
    maker.place(root, b, "Flansch Ø20", moved(9.0, 0.0, 0.0));
    maker.place(root, b, "NAUO7",
                moved(19.0, 0.0, 0.0));  // a name made up by an exporter is replaced by that of the part
    maker.write(folder / "names.step");
    const auto imported = import(folder / "names.step", folder / "out");
    REQUIRE(imported.ok());
    CHECK(imported.report.renamed == 1);
    const assets::Model model = load(folder / "out" / "names.glb");
    for (const char* name : {"Gehäuse 减速器", "Flansch Ø20", "Flansch Ø20_2", "Boden"}) {
        CAPTURE(name);
        CHECK(node_named(model, name) >= 0);
    }
    std::set<std::string> unique;
    for (const assets::Node& node : model.nodes) CHECK(unique.insert(node.name).second);
}

TEST_CASE("Import: colours of shape, face, use and assembly select materials; a face overrides its use") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("root");
    const TopoDS_Shape shape = BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape();
    const TDF_Label painted = maker.part("one", shape, "#2F5D62");
    maker.paint_face(painted, face_towards(shape, 0.0, 0.0, 1.0), "#A8A9A6");
    const TDF_Label plain = maker.part("two", BRepPrimAPI_MakeBox(5.0, 5.0, 5.0).Shape(), "#C8A24A");
    const TDF_Label bare = maker.part("three", BRepPrimAPI_MakeBox(6.0, 6.0, 6.0).Shape());
    maker.place(root, painted, "casing_a", moved(1.0, 0.0, 0.0));
    maker.place(root, plain, "brass_1", moved(50.0, 0.0, 0.0));
    maker.place(root, plain, "brass_2", moved(60.0, 0.0, 0.0));
    maker.paint(maker.place(root, plain, "black_1", moved(70.0, 0.0, 0.0)), "#2B2B2D");
    const TDF_Label group = maker.assembly("group");
    maker.place(group, bare, "red_1", moved(1.0, 0.0, 0.0));
    maker.paint(maker.place(root, group, "group_1", moved(0.0, 80.0, 0.0)), "#B01E28");
    maker.write(folder / "colours.step");
    const auto imported = import(folder / "colours.step", folder / "out");
    REQUIRE(imported.ok());
    const assets::Model model = load(folder / "out" / "colours.glb");
    CHECK(material_of(model, "brass_1") == "brass");
    CHECK(material_of(model, "brass_2") == "brass");
    CHECK(material_of(model, "black_1") == "black_oxide");
    CHECK(material_of(model, "red_1") == "signal_red");
    const auto mesh = [&](const char* name) {
        return model.nodes[static_cast<std::size_t>(node_named(model, name))].mesh;
    };
    CHECK(mesh("brass_1") == mesh("brass_2"));
    CHECK(mesh("brass_1") != mesh("black_1"));
    // The casing has five painted faces in one primitive and the machined face in another.
    const auto& casing = model.meshes[static_cast<std::size_t>(mesh("casing_a"))].primitives;
    REQUIRE(casing.size() == 2);
    for (const assets::Primitive& primitive : casing) {
        const std::string& name = model.materials[static_cast<std::size_t>(primitive.material)].name;
        CAPTURE(name);
        CHECK(primitive.indices.size() == (name == "painted_cast_iron" ? 30U : 6U));
        if (name != "painted_cast_iron") CHECK(name == "machined_cast_iron");
    }
    // Each part still has one closed contact mesh.
    CHECK(load(folder / "out" / "colours.contact.glb").meshes.size() == 3);
    for (const step_import::PartReport& part : imported.report.parts) CHECK(part.open_edges == 0);
}

TEST_CASE("Import: a colour of an ancestor does not override the colour of a part") {
    const Folder folder;
    StepMaker maker;
    const TDF_Label root = maker.assembly("root");
    const TDF_Label pair = maker.assembly("pair");
    const TDF_Label peg = maker.part("peg", BRepPrimAPI_MakeBox(5.0, 5.0, 5.0).Shape(), "#C4C6C8");
    maker.place(pair, peg, "left", moved(1.0, 0.0, 0.0));
    maker.place(pair, peg, "right", moved(10.0, 0.0, 0.0));
    maker.place(root, pair, "first", moved(1.0, 0.0, 0.0));
    maker.paint(maker.place(root, pair, "second", moved(0.0, 30.0, 0.0)), "#C8A24A");
    maker.write(folder / "levels.step");
    REQUIRE(import(folder / "levels.step", folder / "out").ok());
    const assets::Model model = load(folder / "out" / "levels.glb");
    // The colour of the part takes priority over that of the group.
    CHECK(material_of(model, "left") == "machined_steel");
    CHECK(material_of(model, "left_2") == "machined_steel");
    CHECK(model.nodes.size() == 7);
    CHECK(model.meshes.size() == 1);
}
