// Budgets, names at every level, contact models that are closed; and files that are none.
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

// So many triangles, of as few vertices, far away.
void add_triangles(Machine& machine, const std::string& name, std::size_t count) {
    Shape shape;
    shape.points = {{900, 900, 900}, {901, 900, 900}, {900, 901, 900}};
    for (std::size_t i = 0; i < count; ++i) shape.indices.insert(shape.indices.end(), {0, 1, 2});
    machine.add(name, shape);
}

std::size_t count(const Machine& machine) { return geometry::flatten(machine.model).triangle_count(); }

}  // namespace

TEST_CASE("the far level has the same names and fewer triangles") {
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
        R"(4:40: /model_far: the far level has a node "ghost", which the model has not; expected the same names at both levels)");
}

TEST_CASE("triangles are counted with their instances, up to the budget of each level") {
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

TEST_CASE("a file of more than 8 MB") {
    Machine machine;
    Shape shape;
    for (int i = 0; i < 700'000; ++i) shape.points.push_back({900.0 + i * 1e-3, 900.0, 900.0 + (i % 7)});
    shape.indices = {0, 1, 2};
    machine.add("cloud", shape);
    const auto errors = check(machine).errors;
    REQUIRE(errors.size() == 1);
    CHECK(errors[0].starts_with("4:12: /model: the file has 8."));
    CHECK(errors[0].ends_with(" MB; expected at most 8 MB"));
}

TEST_CASE("a contact model is closed, part by part, and has the model's names") {
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
          R"(4:44: /contact_model: "bse" is no node of the model; did you mean "base"?)");
}

TEST_CASE("open edges are counted") {
    Shape shape;
    shape.box({0, 0, 0}, {1, 2, 3});
    auto triangles = triangles_of(shape);
    CHECK(geometry::open_edges(triangles).count == 0);
    std::swap(triangles[4].b,
              triangles[4].c);  // wound the wrong way: each of its edges runs twice the same way
    CHECK(geometry::open_edges(triangles).count == 6);
    triangles.erase(triangles.begin() + 4);
    CHECK(geometry::open_edges(triangles).count == 3);
    CHECK(geometry::open_edges({}).count == 0);
}

TEST_CASE("a file that is no glTF is said at the place that names it") {
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
