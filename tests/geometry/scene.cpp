// Flattening of a model: transforms, names and every topology.
#include "tools/author/geometry/scene.hpp"

#include <doctest/doctest.h>

#include "support.hpp"

using namespace bolt;
using namespace geometry_test;

namespace {

assets::Model one_mesh(assets::Topology topology, std::vector<std::uint32_t> indices) {
    assets::Primitive primitive;
    primitive.topology = topology;
    primitive.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
    primitive.indices = std::move(indices);
    assets::Model model;
    model.meshes.emplace_back().primitives = {primitive};
    model.nodes.emplace_back().mesh = 0;
    model.roots = {0};
    return model;
}

// Sum of the normals along +Z: twice the area of the faces towards +Z, minus that of the faces away from it.
double signed_double_area(const geometry::FlattenedModel& scene) {
    double sum = 0.0;
    for (const geometry::ModelPart& part : scene.parts)
        for (const geometry::Triangle& t : part.triangles) sum += geometry::normal_of(t).z;
    return sum;
}

}  // namespace

TEST_CASE("Geometry: triangles of every topology keep the winding of glTF") {
    using assets::Topology;
    CHECK(signed_double_area(geometry::flatten(one_mesh(Topology::triangles, {0, 1, 2, 1, 3, 2, 4}))) == 2.0);
    CHECK(signed_double_area(geometry::flatten(one_mesh(Topology::triangle_strip, {0, 1, 2, 3}))) == 2.0);
    CHECK(signed_double_area(geometry::flatten(one_mesh(Topology::triangle_strip, {}))) == 3.0);
    CHECK(signed_double_area(geometry::flatten(one_mesh(Topology::triangle_fan, {0, 1, 3, 2}))) == 2.0);
    CHECK(geometry::flatten(one_mesh(Topology::lines, {0, 1, 1, 2})).triangle_count() == 0);
    CHECK(geometry::flatten(one_mesh(Topology::triangles, {0, 1, 9})).triangle_count() == 0);
}

TEST_CASE("Geometry: instances get the pose of their parents and the name of the nearest named ancestor") {
    assets::Model model = one_mesh(assets::Topology::triangles, {0, 1, 2});
    model.nodes.resize(4);
    model.nodes[1].name = "arm";
    model.nodes[1].translation = {0, 0, 5};
    model.nodes[1].rotation = glm::quat(std::sqrt(0.5F), 0.0F, 0.0F, std::sqrt(0.5F));  // X to Y
    model.nodes[1].scale = glm::vec3(2.0F);
    model.nodes[1].children = {0, 2};
    model.nodes[2].name = "hand";
    model.nodes[2].mesh = 0;
    model.nodes[2].translation = {1, 0, 0};
    model.nodes[2].children = {1};  // a loop is visited once
    model.nodes[3].name = "not in the scene";
    model.roots = {1};
    const geometry::FlattenedModel scene = geometry::flatten(model);
    REQUIRE(scene.parts.size() == 2);
    CHECK(scene.parts[0].name == "arm");
    CHECK(scene.parts[1].name == "hand");
    CHECK(scene.triangle_count() == 2);
    CHECK(glm::distance(scene.parts[0].triangles[0].b, Vec3{0, 2, 5}) < 1e-6);
    CHECK(glm::distance(scene.parts[1].triangles[0].a, Vec3{0, 2, 5}) < 1e-6);
    CHECK(scene.names() == std::vector<std::string>{"arm", "hand"});
    CHECK(scene.is_under(scene.parts[1].node, scene.by_name.at("arm").front()));
    CHECK_FALSE(scene.is_under(scene.by_name.at("arm").front(), scene.parts[1].node));
}
