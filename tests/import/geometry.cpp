// Meshes of shapes: volumes against the closed form, closed surfaces, normals, units and open shells.
#include <doctest/doctest.h>

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shell.hxx>
#include <gp_Ax2.hxx>
#include <map>

#include "support.hpp"

using namespace import_test;

namespace {

constexpr double mm3 = 1e-9;

// A box of 40 × 60 × 20 mm with a hole of 10 mm along z.
TopoDS_Shape box_with_hole() {
    return BRepAlgoAPI_Cut(
               BRepPrimAPI_MakeBox(40.0, 60.0, 20.0).Shape(),
               BRepPrimAPI_MakeCylinder(gp_Ax2(gp_Pnt(20.0, 30.0, 0.0), gp::DZ()), 5.0, 20.0).Shape())
        .Shape();
}

// Imports a file with this one part. Returns its contact mesh; `part` receives its report.
assets::Mesh contact_of(const TopoDS_Shape& shape, step_import::PartReport& part, const char* unit = "MM",
                        double deflection = 0.1) {
    const Folder folder;
    StepMaker maker;
    maker.part("part", shape, "#C4C6C8");
    maker.write(folder / "part.step", unit);
    step_import::ImportOptions options;
    options.deflection_mm = deflection;
    const auto imported = import(folder / "part.step", folder / "out", options);
    REQUIRE(imported.ok());
    REQUIRE(imported.report.parts.size() == 1);
    part = imported.report.parts[0];
    const assets::Model model = load(folder / "out" / "part.contact.glb");
    REQUIRE(model.meshes.size() == 1);
    REQUIRE(model.meshes[0].primitives.size() == 1);
    CHECK(model.meshes[0].primitives[0].normals.empty());
    return model.meshes[0];
}

// Number of triangle edges without a partner in the opposite direction, counted in the written file.
std::size_t count_open_edges(const assets::Mesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
    const auto& indices = mesh.primitives[0].indices;
    for (std::size_t i = 0; i < indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = indices[i + k], b = indices[i + (k + 1) % 3];
            balance[std::minmax(a, b)] += a < b ? 1 : -1;
        }
    std::size_t open = 0;
    for (const auto& [side, count] : balance) open += static_cast<std::size_t>(std::abs(count));
    return open;
}

}  // namespace

TEST_CASE("Import: closed contact meshes have the volume of the shape within the deflection") {
    struct Case {
        const char* name;
        TopoDS_Shape shape;
        double volume, area;  // mm³; mm² of curved surface, where the chords deviate
    };
    const Case cases[] = {
        {"box", BRepPrimAPI_MakeBox(40.0, 60.0, 20.0).Shape(), 48000.0, 0.0},
        {"box with a hole", box_with_hole(), 48000.0 - 500.0 * pi, 200.0 * pi},
        {"cylinder", BRepPrimAPI_MakeCylinder(15.0, 50.0).Shape(), 11250.0 * pi, 1500.0 * pi},
        {"sphere", BRepPrimAPI_MakeSphere(20.0).Shape(), 32000.0 / 3.0 * pi, 1600.0 * pi},
        {"cone", BRepPrimAPI_MakeCone(10.0, 0.0, 30.0).Shape(), 1000.0 * pi, 10.0 * pi * 31.623},
        {"torus", BRepPrimAPI_MakeTorus(30.0, 8.0).Shape(), 2.0 * pi * pi * 30.0 * 64.0,
         4.0 * pi * pi * 240.0},
    };
    for (const Case& one : cases)
        for (const double deflection : {0.1, 0.01}) {
            CAPTURE(one.name);
            CAPTURE(deflection);
            step_import::PartReport part;
            const assets::Mesh mesh = contact_of(one.shape, part, "MM", deflection);
            CHECK(part.open_edges == 0);
            CHECK(count_open_edges(mesh) == 0);
            // A positive volume means that the triangles face outwards after the change of frame.
            CHECK(std::abs(volume(mesh) / mm3 - one.volume) <= one.area * deflection + 1e-6 * one.volume);
            CHECK(part.deviation_mm <= deflection);
            if (one.area > 0.0) CHECK(part.deviation_mm > 0.0);
        }
}

TEST_CASE("Import: a finer deflection gives a smaller deviation and more triangles") {
    step_import::PartReport coarse, fine;
    (void)contact_of(BRepPrimAPI_MakeTorus(300.0, 80.0).Shape(), coarse, "MM", 2.0);
    (void)contact_of(BRepPrimAPI_MakeTorus(300.0, 80.0).Shape(), fine, "MM", 0.05);
    CHECK(fine.deviation_mm < 0.3 * coarse.deviation_mm);
    CHECK(fine.triangles > 2 * coarse.triangles);
}

TEST_CASE("Import: files in millimetres, inches and metres give the same size") {
    const double expected = 48000.0 - 500.0 * pi;
    for (const char* unit : {"MM", "INCH", "M"}) {
        CAPTURE(unit);
        step_import::PartReport part;
        const assets::Mesh mesh = contact_of(box_with_hole(), part, unit);
        CHECK(volume(mesh) / mm3 == doctest::Approx(expected).epsilon(0.002));
    }
}

TEST_CASE("Import: Z up becomes Y up in the vertices") {
    step_import::PartReport part;
    const assets::Mesh mesh = contact_of(BRepPrimAPI_MakeBox(40.0, 60.0, 20.0).Shape(), part);
    glm::vec3 low(1e9F), high(-1e9F);
    for (const glm::vec3& p : mesh.primitives[0].positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    CHECK(glm::length(low - glm::vec3(0.0F, 0.0F, -0.06F)) < 1e-7F);
    CHECK(glm::length(high - glm::vec3(0.04F, 0.02F, 0.0F)) < 1e-7F);
}

TEST_CASE("Import: the open edges of a shell are counted and located in the CAD frame") {
    // A box without its lid has four open edges, one chord each.
    BRep_Builder builder;
    TopoDS_Shell shell;
    builder.MakeShell(shell);
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(40.0, 60.0, 20.0).Shape();
    const TopoDS_Shape lid = face_towards(box, 0.0, 0.0, 1.0);
    for (TopExp_Explorer at(box, TopAbs_FACE); at.More(); at.Next())
        if (!at.Current().IsSame(lid)) builder.Add(shell, at.Current());
    step_import::PartReport part;
    const assets::Mesh mesh = contact_of(shell, part);
    CHECK(part.open_edges == 4);
    CHECK(count_open_edges(mesh) == 4);
    REQUIRE(part.open_at_mm.size() == 4);
    double sum = 0.0;
    for (const Vec3& at : part.open_at_mm) {
        CHECK(at.z == doctest::Approx(20.0));  // in the CAD frame
        sum += at.x + at.y;
    }
    CHECK(sum == doctest::Approx(20.0 + 40.0 + 20.0 + 0.0 + 0.0 + 30.0 + 60.0 + 30.0));
}

TEST_CASE("Import: normals are those of the surface, split at edges and shared between tangent faces") {
    const Folder folder;
    StepMaker maker;
    maker.part("box", BRepPrimAPI_MakeBox(10.0, 10.0, 10.0).Shape());
    maker.part("ball", BRepPrimAPI_MakeSphere(gp_Pnt(100.0, 0.0, 0.0), 20.0).Shape());
    maker.write(folder / "two.step");
    REQUIRE(import(folder / "two.step", folder / "out").ok());
    const assets::Model model = load(folder / "out" / "two.glb");
    REQUIRE(model.meshes.size() == 2);
    const assets::Primitive& box = model.meshes[0].primitives[0];
    CHECK(box.positions.size() == 24);  // three at each corner
    CHECK(box.indices.size() == 36);
    const assets::Primitive& ball = model.meshes[1].primitives[0];
    const glm::vec3 centre(0.1F, 0.0F, 0.0F);
    for (std::size_t i = 0; i < ball.positions.size(); ++i)
        CHECK(glm::length(ball.normals[i] - glm::normalize(ball.positions[i] - centre)) < 1e-3F);
    // A closed smooth mesh satisfies Euler's V − E + F = 2 with E = 3F/2, so seam and poles are merged.
    CHECK(ball.positions.size() == 2 + ball.indices.size() / 6);
}

TEST_CASE("Import: a box with rounded edges is one smooth surface") {
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(40.0, 40.0, 40.0).Shape();
    BRepFilletAPI_MakeFillet round(box);
    for (TopExp_Explorer at(box, TopAbs_EDGE); at.More(); at.Next())
        round.Add(5.0, TopoDS::Edge(at.Current()));
    const Folder folder;
    StepMaker maker;
    maker.part("pebble", round.Shape());
    maker.write(folder / "pebble.step");
    const auto imported = import(folder / "pebble.step", folder / "out");
    REQUIRE(imported.ok());
    CHECK(imported.report.parts[0].open_edges == 0);
    const assets::Model model = load(folder / "out" / "pebble.glb");
    const assets::Primitive& pebble = model.meshes[0].primitives[0];
    CHECK(pebble.positions.size() == 2 + pebble.indices.size() / 6);  // Euler: no vertex is split
}
