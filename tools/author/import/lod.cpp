#include "tools/author/import/lod.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <glm/geometric.hpp>

#include "engine/base/math.hpp"
#include "tools/author/import/crease.hpp"
#include "tools/author/import/render_mesh.hpp"

namespace bolt::step_import {

namespace {

// All primitives of a mesh as one: where two materials meet, or an edge is hard, the same place has a vertex
// for either side. The simplifier knows such seams by their positions and moves both sides together.
struct Whole {
    std::vector<glm::vec3> positions;
    std::vector<std::size_t> owner;  // primitive of each vertex
    std::vector<std::uint32_t> indices;
};

Whole join(const assets::Mesh& mesh) {
    Whole whole;
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        const assets::Primitive& primitive = mesh.primitives[p];
        const auto first = static_cast<std::uint32_t>(whole.positions.size());
        whole.positions.insert(whole.positions.end(), primitive.positions.begin(), primitive.positions.end());
        whole.owner.resize(whole.positions.size(), p);
        for (const std::uint32_t index : primitive.indices) whole.indices.push_back(first + index);
    }
    return whole;
}

// A vertex only ever gives way to one of its own side, so the material of a triangle is that of its vertices.
// Their normals have come loose from the surface and are made anew.
void part(const Whole& whole, const std::vector<std::uint32_t>& kept, assets::Mesh& mesh) {
    constexpr double crease = 0.7;       // rad; wider than the far level's chords turn
    constexpr float same = 0.99965732F;  // cos 1.5°
    const std::vector<glm::vec3> normals = crease_normals(whole.positions, kept, crease);
    for (assets::Primitive& primitive : mesh.primitives) {
        primitive.positions.clear();
        primitive.normals.clear();
        primitive.tangents.clear();
        primitive.indices.clear();
    }
    std::vector<std::vector<std::uint32_t>> made(whole.positions.size());  // new vertices of each old one
    for (std::size_t i = 0; i < kept.size(); ++i) {
        assets::Primitive& primitive = mesh.primitives[whole.owner[kept[i - i % 3]]];
        std::vector<std::uint32_t>& vertices = made[kept[i]];
        auto found = std::find_if(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
            return glm::dot(primitive.normals[v], normals[i]) > same;
        });
        if (found == vertices.end()) {
            found = vertices.insert(found, static_cast<std::uint32_t>(primitive.positions.size()));
            primitive.positions.push_back(whole.positions[kept[i]]);
            primitive.normals.push_back(normals[i]);
        }
        primitive.indices.push_back(*found);
    }
    std::erase_if(mesh.primitives, [](const assets::Primitive& one) { return one.indices.empty(); });
}

// Returns the error, m.
double simplify(assets::Mesh& mesh, double error) {
    const Whole whole = join(mesh);
    if (whole.indices.empty()) return 0.0;
    const float* positions = &whole.positions.front().x;
    const float scale = meshopt_simplifyScale(positions, whole.positions.size(), sizeof(glm::vec3));
    if (scale <= 0.0F) return 0.0;
    std::vector<std::uint32_t> kept(whole.indices.size());
    float reached = 0.0F;
    const std::size_t count = meshopt_simplify(kept.data(), whole.indices.data(), whole.indices.size(),
                                               positions, whole.positions.size(), sizeof(glm::vec3), 0,
                                               static_cast<float>(error) / scale, 0, &reached);
    if (count == 0) return 0.0;  // smaller than the error: it stays as it is rather than vanish
    kept.resize(count);
    meshopt_optimizeVertexCache(kept.data(), kept.data(), kept.size(), whole.positions.size());
    part(whole, kept, mesh);
    return static_cast<double>(reached * scale);
}

}  // namespace

FarLevel simplify(const std::vector<assets::Mesh>& meshes, const std::vector<std::size_t>& uses,
                  std::size_t budget, double most_error) {
    const auto total = [&](const std::vector<assets::Mesh>& all) {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < all.size(); ++i) sum += uses[i] * count_triangles(all[i]);
        return sum;
    };
    FarLevel far{meshes, total(meshes), 0.0};
    for (double error = 0.05e-3; far.triangles > budget && error <= most_error; error *= 1.4) {
        far.meshes = meshes;
        far.error = 0.0;
        for (assets::Mesh& mesh : far.meshes) far.error = std::max(far.error, simplify(mesh, error));
        far.triangles = total(far.meshes);
    }
    return far;
}

}  // namespace bolt::step_import
