#include "engine/assets/model.hpp"

#include <doctest/doctest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/assets/document.hpp"

using namespace bolt;
using namespace bolt::assets;

namespace {

Primitive five(Topology topology) {
    Primitive p;
    p.topology = topology;
    p.positions.resize(5);
    return p;
}

using Indices = std::vector<std::uint32_t>;

}  // namespace

TEST_CASE("Topology: every topology number of glTF is read") {
    for (int mode = 0; mode <= 6; ++mode) {
        json document = triangle_document();
        if (mode == 1) document["accessors"][1]["count"] = 2;
        document["meshes"][0]["primitives"][0]["mode"] = mode;
        CHECK(read(document).meshes[0].primitives[0].topology == static_cast<Topology>(mode));
    }
    json document = triangle_document();
    document["meshes"][0]["primitives"][0]["mode"] = 7;
    CHECK(refusal(document).pointer == "/meshes/0/primitives/0/mode");
}

TEST_CASE("Topology: strips and fans have the winding that glTF specifies") {
    CHECK(triangle_indices(five(Topology::triangle_strip)) == Indices{0, 1, 2, 1, 3, 2, 2, 3, 4});
    CHECK(triangle_indices(five(Topology::triangle_fan)) == Indices{1, 2, 0, 2, 3, 0, 3, 4, 0});
    CHECK(triangle_indices(five(Topology::triangles)) == Indices{0, 1, 2});
    CHECK(triangle_indices(five(Topology::points)).empty());
    CHECK(triangle_indices(five(Topology::line_strip)).empty());
    Primitive indexed = five(Topology::triangle_strip);
    indexed.indices = {4, 3, 2, 1};
    CHECK(triangle_indices(indexed) == Indices{4, 3, 2, 3, 1, 2});
}

TEST_CASE("Topology: world transforms multiply from the root down") {
    Model model;
    model.nodes.resize(3);
    model.nodes[2] = {.name = "root",
                      .translation = {1.0F, 0.0F, 0.0F},
                      .rotation = glm::angleAxis(glm::radians(90.0F), glm::vec3(0, 0, 1)),
                      .scale = glm::vec3(2.0F),
                      .children = {0}};
    model.nodes[0] = {.name = "child", .translation = {0.0F, 3.0F, 0.0F}};
    const auto world = world_transforms(model);
    const glm::vec4 origin = world[0] * glm::vec4(0, 0, 0, 1);
    CHECK(glm::distance(glm::vec3(origin), glm::vec3(1.0F - 6.0F, 0.0F, 0.0F)) < 1e-5F);
    CHECK(world[1] == glm::mat4(1.0F));
}
