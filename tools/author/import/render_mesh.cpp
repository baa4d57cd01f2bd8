#include "tools/author/import/render_mesh.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <type_traits>
#include <utility>

namespace bolt::step_import {

namespace {

constexpr double same_normal = 0.99965732;  // cos 1.5°

// One primitive as it grows. Vertices of a point are a chain: there are few of them.
struct Growing {
    int material = -1;
    bool tangents = false;
    assets::Primitive primitive;
    std::vector<Vec3> normals;  // in full precision, for comparing
    std::vector<int> first;     // by point
    std::vector<int> next;      // by vertex

    std::uint32_t vertex(std::uint32_t point, const Vec3& position, const Vec3& normal, const Vec3& tangent) {
        for (int v = first[point]; v >= 0; v = next[static_cast<std::size_t>(v)])
            if (glm::dot(normals[static_cast<std::size_t>(v)], normal) > same_normal)
                return static_cast<std::uint32_t>(v);
        const auto made = static_cast<std::uint32_t>(normals.size());
        next.push_back(first[point]);
        first[point] = static_cast<int>(made);
        normals.push_back(normal);
        primitive.positions.emplace_back(position);
        primitive.normals.push_back(glm::normalize(glm::vec3(normal)));
        if (tangents) primitive.tangents.emplace_back(glm::normalize(glm::vec3(tangent)), 1.0F);
        return made;
    }
};

// Triangles and vertices in an order that graphics cards and compressors like.
void optimise(assets::Primitive& primitive) {
    std::vector<std::uint32_t>& indices = primitive.indices;
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), primitive.positions.size());
    std::vector<unsigned> remap(primitive.positions.size());
    const std::size_t used = meshopt_optimizeVertexFetchRemap(remap.data(), indices.data(), indices.size(),
                                                              primitive.positions.size());
    // Vertices that only triangles without area had are dropped.
    const auto move = [&](auto& stream) {
        if (stream.empty()) return;
        std::remove_reference_t<decltype(stream)> moved(used);
        for (std::size_t i = 0; i < remap.size(); ++i)
            if (remap[i] != ~0U) moved[remap[i]] = stream[i];
        stream = std::move(moved);
    };
    move(primitive.positions);
    move(primitive.normals);
    move(primitive.tangents);
    for (std::uint32_t& index : indices) index = remap[index];
}

bool has_area(const assets::Primitive& primitive, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Vec3 pa = primitive.positions[a], pb = primitive.positions[b], pc = primitive.positions[c];
    const Vec3 cross = glm::cross(pb - pa, pc - pa);
    return glm::dot(cross, cross) > 0.0;
}

}  // namespace

assets::Mesh render_mesh(const PartMesh& part, const std::vector<int>& faces,
                         const std::vector<assets::Material>& materials, std::string name) {
    std::vector<Growing> growing;
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        const FaceMesh& face = part.faces[f];
        if (face.triangles.empty()) continue;
        auto found = std::find_if(growing.begin(), growing.end(),
                                  [&](const Growing& one) { return one.material == faces[f]; });
        if (found == growing.end()) {
            found = growing.insert(growing.end(), Growing{});
            found->material = found->primitive.material = faces[f];
            found->tangents = materials[static_cast<std::size_t>(faces[f])].anisotropy > 0.0F;
            found->first.assign(part.points.size(), -1);
        }
        for (const auto& triangle : face.triangles) {
            std::array<std::uint32_t, 3> v{};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t point = face.points[triangle[k]];
                v[k] = found->vertex(point, part.points[point], face.normals[triangle[k]],
                                     face.tangents[triangle[k]]);
            }
            if (has_area(found->primitive, v[0], v[1], v[2]))
                found->primitive.indices.insert(found->primitive.indices.end(), v.begin(), v.end());
        }
    }
    assets::Mesh mesh;
    mesh.name = std::move(name);
    for (Growing& one : growing) {
        if (one.primitive.indices.empty()) continue;
        optimise(one.primitive);
        mesh.primitives.push_back(std::move(one.primitive));
    }
    return mesh;
}

std::size_t count_triangles(const assets::Mesh& mesh) {
    std::size_t count = 0;
    for (const assets::Primitive& primitive : mesh.primitives) count += primitive.indices.size() / 3;
    return count;
}

}  // namespace bolt::step_import
