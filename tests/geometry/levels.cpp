// Budgets, node names at every level, closed contact models and invalid files.
#include <doctest/doctest.h>

#include <filesystem>
#include <memory>

#include "engine/base/file.hpp"
#include "support.hpp"
#include "tests/support/folder.hpp"
#include "tools/author/geometry/check_model.hpp"
#include "tools/author/geometry/scene.hpp"

using namespace bolt;
using namespace geometry_test;

namespace {

// Adds `count` triangles with few vertices, far from the joints.
void add_triangles(Machine& machine, const std::string& name, std::size_t count) {
    PrismMesh shape;
    shape.points = {{900, 900, 900}, {901, 900, 900}, {900, 901, 900}};
    for (std::size_t i = 0; i < count; ++i) shape.indices.insert(shape.indices.end(), {0, 1, 2});
    machine.add(name, shape);
}

std::size_t count(const Machine& machine) { return geometry::flatten(machine.model).triangle_count(); }

}  // namespace

TEST_CASE("Geometry: the far level must have the node names of the near level") {
    CHECK(all(check(Machine(), {}, std::make_unique<Machine>().get()).errors) == "");
    Machine far;
    far.model.nodes[static_cast<std::size_t>(far.node("cover"))].name = "covr";
    CHECK(
        all(check(Machine(), {}, &far).errors) ==
        R"(4:40: /model_far: the far level has no node "cover", which the model has; did you mean "covr"?)");
    Machine more;
    add_triangles(more, "ghost", 1);
    CHECK(
        all(check(Machine(), {}, &more).errors) ==
        R"(4:40: /model_far: the far level has a node "ghost", which the model lacks; expected the same names at both levels)");
}

TEST_CASE("Geometry: the triangle budget of each level counts instances") {
    Machine machine({{0, 0, 0}, {0, 0, 300}});
    const std::size_t base = count(machine);
    add_triangles(machine, "load", 60'000 - base);
    CHECK(count(machine) == 60'000);
    CHECK(all(check(machine, {}, &machine).errors) == "");
    Machine two({{0, 0, 0}, {0, 0, 300}}), over = two;
    add_triangles(over, "load", 60'001 - base);
    add_triangles(two, "load", 250'001 - base);
    CHECK(all(check(two, {}, &over).errors) ==
          "4:12: /model: the model has 250001 triangles; expected at most 250000: import it with a larger "
          "deflection\n"
          "4:40: /model_far: the model has 60001 triangles; expected at most 60000: import it with a larger "
          "deflection");
    CHECK(all(check(over).errors) == "");
}

TEST_CASE("Geometry: a file of more than 8 MB is an error") {
    Machine machine;
    PrismMesh shape;
    for (int i = 0; i < 700'000; ++i) shape.points.push_back({900.0 + i * 1e-3, 900.0, 900.0 + (i % 7)});
    shape.indices = {0, 1, 2};
    machine.add("cloud", shape);
    const auto errors = check(machine).errors;
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].starts_with("4:12: /model: the file has 8."));
    CHECK(errors[0].ends_with(" MB; expected at most 8 MB"));
}

TEST_CASE("Geometry: each part of the contact model is closed and has a name of the model") {
    Machine closed;
    CHECK(all(check(Machine(), {}, nullptr, &closed.model).errors) == "");
    Machine open;
    auto& mesh = open.model.meshes[static_cast<std::size_t>(
        open.model.nodes[static_cast<std::size_t>(open.node("base"))].mesh)];
    mesh.primitives[0].indices.resize(mesh.primitives[0].indices.size() - 3);
    const auto errors = check(Machine(), {}, nullptr, &open.model).errors;
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].starts_with(R"(4:44: /contact_model: "base" has 3 open edges, one near [)"));
    CHECK(errors[0].ends_with("mm; expected a closed surface"));
    Machine other;
    other.model.nodes[static_cast<std::size_t>(other.node("base"))].name = "bse";
    CHECK(all(check(Machine(), {}, nullptr, &other.model).errors) ==
          R"(4:44: /contact_model: "bse" is not a node of the model; did you mean "base"?)");
}

TEST_CASE("Geometry: open edges are counted") {
    PrismMesh shape;
    shape.box({0, 0, 0}, {1, 2, 3});
    auto triangles = triangles_of(shape);
    CHECK(geometry::open_edges(triangles).count == 0);
    std::swap(triangles[4].b,
              triangles[4].c);  // flips the winding: each of its edges runs twice in one direction
    CHECK(geometry::open_edges(triangles).count == 6);
    triangles.erase(triangles.begin() + 4);
    CHECK(geometry::open_edges(triangles).count == 3);
    CHECK(geometry::open_edges({}).count == 0);
}

TEST_CASE("Geometry: an invalid glTF file is reported at the property that names it") {
    const test::Folder root;
    REQUIRE(write_file(root / "bad.glb", "nothing of the kind"));
    std::string text = R"({"title": {"en": "x"},
"model": "bad.glb"})";
    content::Assembly assembly;
    assembly.text = text;
    assembly.file = (root / "assembly.json").string();
    assembly.models.model = (root / "bad.glb").string();
    const auto findings = geometry::check_geometry(assembly);
    REQUIRE(findings.errors.size() == 1);
    CHECK(findings.errors[0].line == 2);
    CHECK(findings.errors[0].column == 10);
    CHECK(findings.errors[0].pointer == "/model");
    CHECK(findings.errors[0].what.find("bad.glb") != std::string::npos);
}
