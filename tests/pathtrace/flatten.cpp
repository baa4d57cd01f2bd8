// Tests of node patterns, and of nodes, skins and morph targets resolved into triangles.
#include <doctest/doctest.h>

#include "tests/pathtrace/shapes.hpp"
#include "tools/verify/pathtrace/flatten.hpp"

using namespace bolt;
using namespace bolt::pathtrace;

TEST_CASE("Path tracer: names match patterns with * and ?") {
    CHECK(matches("joint_B1", "joint_B1"));
    CHECK(matches("joint_*", "joint_B1"));
    CHECK(matches("*B?", "joint_B1"));
    CHECK(matches("*", "joint_B1"));
    CHECK(matches("a*b*c", "aXbXc"));
    CHECK(matches("*", ""));
    CHECK_FALSE(matches("joint_B", "joint_B1"));
    CHECK_FALSE(matches("B1", "joint_B1"));
    CHECK_FALSE(matches("?oint", "joint_B1"));
    CHECK_FALSE(matches("a*d", "abc"));
}

TEST_CASE("Path tracer: nodes are shown and hidden with their descendants") {
    assets::Model model = single(square(), matte(glm::vec3(1.0F)));
    model.nodes[0].children = {1};
    model.nodes[0].translation = {0.0F, 0.0F, 5.0F};
    model.nodes.push_back({.name = "lid", .translation = {1.0F, 0.0F, 0.0F}, .mesh = 0});
    CHECK(flatten(model, {}).triangles.size() == 4);
    const FlatMesh lid = flatten(model, {.show = {"li*"}, .hide = {}});
    REQUIRE(lid.triangles.size() == 2);
    CHECK(lid.vertices[0].position == glm::vec3(0.0F, -1.0F, 5.0F));
    CHECK(flatten(model, {.show = {}, .hide = {"lid"}}).triangles.size() == 2);
    CHECK(flatten(model, {.show = {"lid"}, .hide = {"node"}}).triangles.empty());
}

TEST_CASE("Path tracer: morph targets are applied before the skin") {
    assets::Model model = single(square(), matte(glm::vec3(1.0F)));
    assets::Primitive& p = model.meshes[0].primitives[0];
    p.joints.assign(4, {0, 1, 0, 0});
    p.weights.assign(4, {0.25F, 0.75F, 0.0F, 0.0F});
    p.targets.resize(1);
    p.targets[0].positions.assign(4, {0.0F, 0.0F, 0.5F});
    model.meshes[0].weights = {1.0F};
    model.nodes[0].skin = 0;
    model.nodes[0].translation = {100.0F, 0.0F, 0.0F};  // glTF ignores the transform of a skinned node
    model.nodes.push_back({.name = "a", .translation = {4.0F, 0.0F, 0.0F}});
    model.nodes.push_back({.name = "b", .translation = {0.0F, 8.0F, 0.0F}});
    model.roots = {0, 1, 2};
    model.skins = {{.name = "rig", .joints = {1, 2}}};
    const FlatMesh flat = flatten(model, {});
    CHECK(flat.vertices[0].position == glm::vec3(-1.0F + 1.0F, -1.0F + 6.0F, 0.5F));
    CHECK(flat.vertices[0].normal == glm::vec3(0.0F, 0.0F, 1.0F));
}

TEST_CASE("Path tracer: the triangles of a mirrored node still face outward") {
    assets::Model model = single(square(), matte(glm::vec3(1.0F)));
    model.nodes[0].scale = {-1.0F, 1.0F, 1.0F};
    const FlatMesh flat = flatten(model, {});
    const auto& t = flat.triangles[0].corners;
    const glm::vec3 a = flat.vertices[t[0]].position;
    const glm::vec3 normal = glm::cross(flat.vertices[t[1]].position - a, flat.vertices[t[2]].position - a);
    CHECK(normal.z > 0.0F);
    CHECK(flat.vertices[0].normal == glm::vec3(0.0F, 0.0F, 1.0F));
}
