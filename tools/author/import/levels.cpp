#include "tools/author/import/levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>
#include <tuple>
#include <type_traits>
#include <utility>

#include "engine/base/math.hpp"

namespace bolt::step_import {

namespace {

// Returns one id for each vertex; vertices at equal positions have the same id.
std::vector<std::uint32_t> position_ids(const std::vector<glm::vec3>& positions) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t i) {
        return std::tuple(positions[i].x, positions[i].y, positions[i].z);
    };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> position_id(positions.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        position_id[order[i]] =
            i > 0 && key(order[i]) == key(order[i - 1]) ? position_id[order[i - 1]] : order[i];
    return position_id;
}

}  // namespace

std::vector<glm::vec3> crease_normals(const std::vector<glm::vec3>& positions,
                                      const std::vector<std::uint32_t>& indices, double crease) {
    const std::vector<std::uint32_t> position_id = position_ids(positions);
    std::vector<std::vector<std::uint32_t>> around(positions.size());  // triangles, by position id
    std::vector<Vec3> area(indices.size() / 3), facing(indices.size() / 3);
    for (std::uint32_t t = 0; t < area.size(); ++t) {
        const auto p = [&](std::size_t k) { return Vec3(positions[indices[3 * t + k]]); };
        area[t] = glm::cross(p(1) - p(0), p(2) - p(0));
        const double length = glm::length(area[t]);
        if (length > 0.0) facing[t] = area[t] / length;
        for (std::size_t k = 0; k < 3; ++k) around[position_id[indices[3 * t + k]]].push_back(t);
    }
    const double least = std::cos(crease);
    std::vector<glm::vec3> normals(indices.size());
    for (std::size_t i = 0; i < indices.size(); ++i) {
        Vec3 sum{0.0};
        for (const std::uint32_t t : around[position_id[indices[i]]])
            if (glm::dot(facing[t], facing[i / 3]) > least) sum += area[t];
        const double length = glm::length(sum);
        normals[i] = length > 0.0 ? glm::vec3(sum / length) : glm::vec3(0.0F, 1.0F, 0.0F);
    }
    return normals;
}

namespace {

constexpr double same_normal = 0.99965732;  // cos 1.5°

// Builds one primitive. The few vertices of a point form a linked list.
struct PrimitiveBuilder {
    int material = -1;
    bool tangents = false;
    assets::Primitive primitive;
    std::vector<Vec3> normals;  // in double precision, for comparison
    std::vector<int> first;     // by point: its first vertex; −1: none
    std::vector<int> next;      // by vertex: the next one of its point; −1: none

    // Returns the vertex of the point with this normal; adds it if needed.
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

// Reorders triangles and vertices for the vertex cache of the GPU and for compression.
void optimise_order(assets::Primitive& primitive) {
    std::vector<std::uint32_t>& indices = primitive.indices;
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), primitive.positions.size());
    std::vector<unsigned> remap(primitive.positions.size());
    const std::size_t used = meshopt_optimizeVertexFetchRemap(remap.data(), indices.data(), indices.size(),
                                                              primitive.positions.size());
    // Drops the vertices that no triangle uses.
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
    std::vector<PrimitiveBuilder> builders;
    for (std::size_t f = 0; f < part.faces.size(); ++f) {
        const FaceMesh& face = part.faces[f];
        if (face.triangles.empty()) continue;
        auto found = std::find_if(builders.begin(), builders.end(),
                                  [&](const PrimitiveBuilder& one) { return one.material == faces[f]; });
        if (found == builders.end()) {
            found = builders.insert(builders.end(), PrimitiveBuilder{});
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
    for (PrimitiveBuilder& one : builders) {
        if (one.primitive.indices.empty()) continue;
        optimise_order(one.primitive);
        mesh.primitives.push_back(std::move(one.primitive));
    }
    return mesh;
}

std::size_t count_triangles(const assets::Mesh& mesh) {
    std::size_t count = 0;
    for (const assets::Primitive& primitive : mesh.primitives) count += primitive.indices.size() / 3;
    return count;
}

namespace {

// All primitives of a mesh in one. At a material boundary or a sharp edge the same position has one vertex
// for each side; the simplifier recognises such seams by their positions and moves both sides together.
struct JoinedMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::size_t> owner;  // primitive of each vertex
    std::vector<std::uint32_t> indices;
};

JoinedMesh join_primitives(const assets::Mesh& mesh) {
    JoinedMesh joined;
    for (std::size_t p = 0; p < mesh.primitives.size(); ++p) {
        const assets::Primitive& primitive = mesh.primitives[p];
        const auto first = static_cast<std::uint32_t>(joined.positions.size());
        joined.positions.insert(joined.positions.end(), primitive.positions.begin(),
                                primitive.positions.end());
        joined.owner.resize(joined.positions.size(), p);
        for (const std::uint32_t index : primitive.indices) joined.indices.push_back(first + index);
    }
    return joined;
}

// Distributes the kept triangles over the primitives of `mesh` with new normals, because the simplified
// triangles no longer lie on the surface. The simplifier merges vertices only within one side of a seam, so
// the vertices of a triangle determine its material.
void split_primitives(const JoinedMesh& joined, const std::vector<std::uint32_t>& kept, assets::Mesh& mesh) {
    constexpr double crease = 0.7;  // rad; larger than the angle between neighbouring chords of the far level
    const std::vector<glm::vec3> normals = crease_normals(joined.positions, kept, crease);
    for (assets::Primitive& primitive : mesh.primitives) {
        primitive.positions.clear();
        primitive.normals.clear();
        primitive.tangents.clear();
        primitive.indices.clear();
    }
    std::vector<std::vector<std::uint32_t>> made(joined.positions.size());  // new vertices of each old one
    for (std::size_t i = 0; i < kept.size(); ++i) {
        assets::Primitive& primitive = mesh.primitives[joined.owner[kept[i - i % 3]]];
        std::vector<std::uint32_t>& vertices = made[kept[i]];
        auto found = std::find_if(vertices.begin(), vertices.end(), [&](std::uint32_t v) {
            return glm::dot(primitive.normals[v], normals[i]) > static_cast<float>(same_normal);
        });
        if (found == vertices.end()) {
            found = vertices.insert(found, static_cast<std::uint32_t>(primitive.positions.size()));
            primitive.positions.push_back(joined.positions[kept[i]]);
            primitive.normals.push_back(normals[i]);
        }
        primitive.indices.push_back(*found);
    }
    std::erase_if(mesh.primitives, [](const assets::Primitive& one) { return one.indices.empty(); });
}

// Simplifies one mesh up to `error` (m). Returns the error reached, m.
double simplify_mesh(assets::Mesh& mesh, double error) {
    const JoinedMesh joined = join_primitives(mesh);
    if (joined.indices.empty()) return 0.0;
    const float* positions = &joined.positions.front().x;
    const float scale = meshopt_simplifyScale(positions, joined.positions.size(), sizeof(glm::vec3));
    if (scale <= 0.0F) return 0.0;
    std::vector<std::uint32_t> kept(joined.indices.size());
    float reached = 0.0F;
    const std::size_t count = meshopt_simplify(kept.data(), joined.indices.data(), joined.indices.size(),
                                               positions, joined.positions.size(), sizeof(glm::vec3), 0,
                                               static_cast<float>(error) / scale, 0, &reached);
    if (count == 0) return 0.0;  // the mesh is smaller than the error: keep it unchanged
    kept.resize(count);
    meshopt_optimizeVertexCache(kept.data(), kept.data(), kept.size(), joined.positions.size());
    split_primitives(joined, kept, mesh);
    return static_cast<double>(reached * scale);
}

}  // namespace

FarLevel simplify(const std::vector<assets::Mesh>& meshes, const std::vector<std::size_t>& uses,
                  std::size_t budget, double max_error) {
    const auto total = [&](const std::vector<assets::Mesh>& all) {
        std::size_t sum = 0;
        for (std::size_t i = 0; i < all.size(); ++i) sum += uses[i] * count_triangles(all[i]);
        return sum;
    };
    FarLevel far{meshes, total(meshes), 0.0};
    for (double error = 0.05e-3; far.triangles > budget && error <= max_error; error *= 1.4) {
        far.meshes = meshes;
        far.error = 0.0;
        for (assets::Mesh& mesh : far.meshes) far.error = std::max(far.error, simplify_mesh(mesh, error));
        far.triangles = total(far.meshes);
    }
    return far;
}

namespace {

struct DirectedEdge {
    std::uint32_t low, high;
    int direction;  // +1: from low to high; −1: from high to low
    friend auto operator<=>(const DirectedEdge&, const DirectedEdge&) = default;
};

}  // namespace

OpenEdgeList open_edges(const PartMesh& mesh, std::size_t max_listed) {
    std::vector<DirectedEdge> edges;
    edges.reserve(3 * count_triangles(mesh));
    for (const FaceMesh& face : mesh.faces)
        for (const auto& triangle : face.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = face.points[triangle[k]], b = face.points[triangle[(k + 1) % 3]];
                edges.push_back({std::min(a, b), std::max(a, b), a < b ? 1 : -1});
            }
    std::sort(edges.begin(), edges.end());
    OpenEdgeList open;
    for (std::size_t i = 0; i < edges.size();) {
        int balance = 0;
        const std::size_t first = i;
        for (; i < edges.size() && edges[i].low == edges[first].low && edges[i].high == edges[first].high;
             ++i)
            balance += edges[i].direction;
        if (balance == 0) continue;
        open.count += static_cast<std::size_t>(std::abs(balance));
        if (open.first.size() < max_listed)
            open.first.push_back(0.5 * (mesh.points[edges[first].low] + mesh.points[edges[first].high]));
    }
    return open;
}

PartContactMesh contact_mesh(const PartMesh& mesh, std::string name) {
    PartContactMesh contact;
    contact.mesh.name = std::move(name);
    contact.triangles = count_triangles(mesh);
    contact.open = open_edges(mesh);
    if (contact.triangles == 0) return contact;
    assets::Primitive primitive;
    std::vector<std::uint32_t> used(mesh.points.size(), 0xFFFFFFFFU);
    for (const FaceMesh& face : mesh.faces)
        for (const auto& triangle : face.triangles)
            for (const std::uint32_t corner : triangle) {
                std::uint32_t& index = used[face.points[corner]];
                if (index == 0xFFFFFFFFU) {
                    index = static_cast<std::uint32_t>(primitive.positions.size());
                    primitive.positions.emplace_back(mesh.points[face.points[corner]]);
                }
                primitive.indices.push_back(index);
            }
    contact.mesh.primitives.push_back(std::move(primitive));
    return contact;
}

}  // namespace bolt::step_import
