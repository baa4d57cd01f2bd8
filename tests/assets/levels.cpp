// Levels of detail of simple shapes.
#include "engine/assets/levels.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <numbers>

namespace assets_levels_test {

using namespace bolt;
using namespace bolt::assets;

namespace {

struct Mesh {
    std::vector<glm::vec3> positions, normals;
    std::vector<std::uint32_t> indices;
};

// Extrudes a profile of points with normals along z in steps.
Mesh extruded(const std::vector<std::pair<glm::vec2, glm::vec2>>& profile, std::uint32_t steps) {
    Mesh mesh;
    const auto columns = static_cast<std::uint32_t>(profile.size());
    for (std::uint32_t row = 0; row <= steps; ++row)
        for (const auto& [point, normal] : profile) {
            mesh.positions.emplace_back(point, static_cast<float>(row) / static_cast<float>(steps));
            mesh.normals.emplace_back(normal, 0.0F);
        }
    for (std::uint32_t row = 0; row < steps; ++row)
        for (std::uint32_t i = 0; i + 1 < columns; ++i) {
            if (profile[i].first == profile[i + 1].first) continue;  // the duplicated vertices of a hard edge
            const std::uint32_t a = row * columns + i, b = a + 1, c = a + columns, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
        }
    return mesh;
}

// Two flats at a right angle with a fillet of this radius: the first faces up, the second +x.
Mesh filleted(float radius) {
    std::vector<std::pair<glm::vec2, glm::vec2>> profile;
    for (int i = 0; i < 12; ++i) profile.push_back({{static_cast<float>(i) / 12.0F - 1.0F, 0.0F}, {0, 1}});
    constexpr int arc = 16;
    for (int i = 0; i <= arc; ++i) {
        const float angle = std::numbers::pi_v<float> / 2.0F * (1.0F - static_cast<float>(i) / arc);
        const glm::vec2 n(std::cos(angle), std::sin(angle));
        profile.push_back({glm::vec2(0.0F, -radius) + radius * n, n});
    }
    for (int i = 1; i <= 12; ++i)
        profile.push_back({{radius, -radius - static_cast<float>(i) / 12.0F}, {1, 0}});
    return extruded(profile, 24);
}

// The same flats with a hard edge instead of the fillet; the vertices on the edge are duplicated.
Mesh edged() {
    std::vector<std::pair<glm::vec2, glm::vec2>> profile;
    for (int i = 0; i <= 12; ++i) profile.push_back({{static_cast<float>(i) / 12.0F - 1.0F, 0.0F}, {0, 1}});
    for (int i = 0; i <= 12; ++i) profile.push_back({{0.0F, -static_cast<float>(i) / 12.0F}, {1, 0}});
    return extruded(profile, 24);
}

struct Corner {
    glm::vec3 position, normal;
};

Corner corner(const Mesh& mesh, const LevelOfDetail& level, std::uint32_t index) {
    if (index < mesh.positions.size()) return {mesh.positions[index], mesh.normals[index]};
    const AddedVertex& added = level.added.at(index - mesh.positions.size());
    return {mesh.positions.at(added.source), added.normal};
}

double angle_between(const glm::vec3& a, const glm::vec3& b) {
    return std::acos(std::clamp(glm::dot(glm::dvec3(a), glm::dvec3(b)), -1.0, 1.0));
}

// The largest angle between a normal and its triangle, for triangles on the flats and for others.
struct Turned {
    double flats = 0.0, round = 0.0;
    std::size_t in_flats = 0;
};
Turned turned(const Mesh& mesh, const LevelOfDetail& level) {
    Turned result;
    for (std::size_t i = 0; i < level.indices.size(); i += 3) {
        const Corner a = corner(mesh, level, level.indices[i]), b = corner(mesh, level, level.indices[i + 1]),
                     c = corner(mesh, level, level.indices[i + 2]);
        const glm::vec3 area = glm::cross(b.position - a.position, c.position - a.position);
        if (glm::length(area) < 1e-9F) continue;
        const glm::vec3 face = glm::normalize(area);
        const bool flat = std::max(face.x, face.y) > 0.99999F;
        if (flat) ++result.in_flats;
        for (const Corner& one : {a, b, c}) {
            CHECK(glm::length(one.normal) == doctest::Approx(1.0).epsilon(1e-4));
            double& worst = flat ? result.flats : result.round;
            worst = std::max(worst, angle_between(one.normal, face));
        }
    }
    return result;
}

}  // namespace

TEST_CASE("Levels of detail: flats beside a fillet stay flat at every level, and the fillet stays smooth") {
    const Mesh mesh = filleted(0.05F);
    const std::vector<LevelOfDetail> levels = coarser_levels(mesh.positions, mesh.normals, mesh.indices);
    REQUIRE(levels.size() >= 3);
    std::size_t before = mesh.indices.size();
    float error = 0.0F;
    for (const LevelOfDetail& level : levels) {
        CHECK(level.indices.size() * 4 <= before * 3);
        CHECK(level.error >= error);
        before = level.indices.size();
        error = level.error;
        const Turned most = turned(mesh, level);
        REQUIRE(most.in_flats > 0);
        CHECK(most.flats < 0.11);
        CHECK(most.round < 1.06);
    }
}

TEST_CASE("Levels of detail: a hard edge stays hard") {
    const Mesh mesh = edged();
    const std::vector<LevelOfDetail> levels = coarser_levels(mesh.positions, mesh.normals, mesh.indices);
    REQUIRE_FALSE(levels.empty());
    for (const LevelOfDetail& level : levels) {
        CHECK(level.added.empty());
        CHECK(turned(mesh, level).flats < 1e-3);
        CHECK(level.error < 1e-4F);
    }
    CHECK(levels.back().indices.size() < mesh.indices.size() / 4);
}

TEST_CASE("Levels of detail: seams are kept without welding, and flats stay flat") {
    const Mesh mesh = edged();
    const std::vector<LevelOfDetail> levels =
        coarser_levels(mesh.positions, mesh.normals, mesh.indices, {.weld = false});
    REQUIRE_FALSE(levels.empty());
    for (const LevelOfDetail& level : levels) CHECK(turned(mesh, level).flats < 1e-3);
    const Mesh round = filleted(0.05F);
    for (const LevelOfDetail& level :
         coarser_levels(round.positions, round.normals, round.indices, {.weld = false}))
        CHECK(turned(round, level).flats < 0.11);
}

TEST_CASE("Levels of detail: without normals only indices change, and no corner crosses an edge") {
    const Mesh mesh = edged();
    const std::vector<LevelOfDetail> levels = coarser_levels(mesh.positions, {}, mesh.indices);
    REQUIRE_FALSE(levels.empty());
    for (const LevelOfDetail& level : levels) {
        CHECK(level.added.empty());
        for (const std::uint32_t index : level.indices) REQUIRE(index < mesh.positions.size());
        CHECK(turned(mesh, level).flats < 1e-3);
    }
}

TEST_CASE("Levels of detail: small and empty meshes have no coarser level") {
    CHECK(coarser_levels({}, {}, {}).empty());
    const Mesh mesh = extruded({{{0, 0}, {0, 1}}, {{1, 0}, {0, 1}}}, 4);
    CHECK(coarser_levels(mesh.positions, mesh.normals, mesh.indices).empty());
    // A thousand degenerate triangles.
    const std::vector<glm::vec3> points(9, glm::vec3(1, 2, 3)), normals(9, glm::vec3(0, 1, 0));
    std::vector<std::uint32_t> indices;
    for (std::uint32_t i = 0; i < 3000; ++i) indices.push_back(i % 9);
    CHECK(coarser_levels(points, normals, indices).empty());
    CHECK(coarser_levels(points, {}, indices).size() <= 6);
}

}  // namespace assets_levels_test
