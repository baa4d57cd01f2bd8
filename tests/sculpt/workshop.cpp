// Tests of the workshop model.
#include "tools/assets/sculpt/generated_content.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>

#include "tools/assets/sculpt/environment.hpp"
#include "tools/assets/sculpt/mesh.hpp"

namespace sculpt_workshop_test {

using namespace bolt;
using namespace bolt::sculpt;

namespace {

const assets::Model& workshop() {
    static const assets::Model made = [] {
        Result<assets::Model> result = make_workshop();
        REQUIRE(result.has_value());
        return std::move(*result);
    }();
    return made;
}

const assets::Mesh& mesh_of(const std::string& name) {
    const assets::Model& model = workshop();
    const auto node = std::find_if(model.nodes.begin(), model.nodes.end(),
                                   [&](const assets::Node& n) { return n.name == name; });
    REQUIRE(node != model.nodes.end());
    REQUIRE(node->mesh >= 0);
    return model.meshes[static_cast<std::size_t>(node->mesh)];
}

}  // namespace

TEST_CASE("Workshop: the model is within its triangle budget and node names are unique") {
    std::size_t triangles = 0;
    std::set<std::string> names;
    for (const assets::Node& node : workshop().nodes) {
        CHECK(names.insert(node.name).second);
        if (node.mesh < 0) continue;
        for (const assets::Primitive& p : workshop().meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            triangles += p.indices.size() / 3;
        }
    }
    CHECK(triangles <= 60000);
    CHECK(names.count("machine_mount") == 1);
}

TEST_CASE(
    "Workshop: the clamping plate's upper face is y = 0 and fits the reducer's foot; the floor is below") {
    float top = -1.0F;
    glm::vec3 low(9.0F);
    glm::vec3 high(-9.0F);
    for (const assets::Primitive& part : mesh_of("clamping_plate").primitives) {
        for (const glm::vec3& p : part.positions) {
            top = std::max(top, p.y);
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    }
    CHECK(top == 0.0F);
    CHECK(high.x - low.x == doctest::Approx(1.0));
    CHECK(high.z - low.z == doctest::Approx(0.62));
    CHECK(low.x == -high.x);
    for (const assets::Primitive& part : mesh_of("floor").primitives) {
        for (const glm::vec3& p : part.positions) CHECK(p.y <= static_cast<float>(room::floor) + 1e-6F);
    }
}

TEST_CASE("Workshop: boxes and tools are closed and oriented outward") {
    for (const std::string name : {"floor", "clamping_plate", "bench_top", "bench_drawers", "tool_board"}) {
        CAPTURE(name);
        TriMesh all;
        for (const assets::Primitive& part : mesh_of(name).primitives) {
            const auto base = static_cast<std::uint32_t>(all.positions.size());
            for (const glm::vec3& p : part.positions) all.positions.emplace_back(p);
            for (std::size_t i = 0; i < part.indices.size(); i += 3) {
                all.triangles.push_back(
                    {base + part.indices[i], base + part.indices[i + 1], base + part.indices[i + 2]});
            }
        }
        const TriMesh closed = weld(all);
        CHECK(open_edges(closed) == 0);
        CHECK(volume(closed) > 0.0);
    }
}

TEST_CASE("Workshop: normals agree with their triangles") {
    for (const assets::Mesh& mesh : workshop().meshes) {
        CAPTURE(mesh.name);
        std::size_t against = 0;
        std::size_t count = 0;
        for (const assets::Primitive& part : mesh.primitives) {
            for (std::size_t i = 0; i < part.indices.size(); i += 3, ++count) {
                const Vec3 a(part.positions[part.indices[i]]);
                const Vec3 b(part.positions[part.indices[i + 1]]);
                const Vec3 c(part.positions[part.indices[i + 2]]);
                Vec3 mean(0.0);
                for (std::size_t k = 0; k < 3; ++k) mean += Vec3(part.normals[part.indices[i + k]]);
                against += glm::dot(glm::cross(b - a, c - a), mean) < -1e-12 ? 1U : 0U;
            }
        }
        CHECK(against <= count / 200);
    }
}

}  // namespace sculpt_workshop_test
