#include "engine/assets/levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

namespace bolt::assets {

namespace {

// Items grouped by a key, stored in one array.
struct Groups {
    std::vector<std::uint32_t> first;  // start of each group, and the end of the last one
    std::vector<std::uint32_t> items;

    Groups(std::span<const std::uint32_t> group_of, std::size_t count)
        : first(count + 1, 0), items(group_of.size()) {
        for (const std::uint32_t group : group_of) ++first[group + 1];
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for (std::uint32_t i = 0; i < group_of.size(); ++i) items[next[group_of[i]]++] = i;
    }
    [[nodiscard]] std::span<const std::uint32_t> of(std::uint32_t group) const {
        return std::span(items).subspan(first[group], first[group + 1] - first[group]);
    }
};

// The mesh without seams: one vertex per position. Without welding: the mesh as it is.
struct WeldedMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> position_of;  // for each original vertex, its index in `positions`
    std::vector<std::uint32_t> indices;      // into `positions`
};

WeldedMesh weld_mesh(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices,
                     bool weld) {
    WeldedMesh mesh;
    mesh.position_of.resize(positions.size());
    std::iota(mesh.position_of.begin(), mesh.position_of.end(), 0U);
    std::size_t count = positions.size();
    if (weld)
        count = meshopt_generateVertexRemap(mesh.position_of.data(), nullptr, positions.size(),
                                            positions.data(), positions.size(), sizeof(glm::vec3));
    mesh.positions.resize(count);
    for (std::size_t i = 0; i < positions.size(); ++i) mesh.positions[mesh.position_of[i]] = positions[i];
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = mesh.position_of[indices[i]], b = mesh.position_of[indices[i + 1]],
                            c = mesh.position_of[indices[i + 2]];
        if (a != b && b != c && c != a) mesh.indices.insert(mesh.indices.end(), {a, b, c});
    }
    return mesh;
}

constexpr float min_same_normal_cosine = 0.99965732F;  // cos 1.5°

// Returns, for each vertex, the first vertex with the same position and nearly the same normal: the surface
// is smooth between them.
std::vector<std::uint32_t> smooth_groups(std::span<const glm::vec3> positions,
                                         std::span<const glm::vec3> normals) {
    std::vector<std::uint32_t> position(positions.size()), group(positions.size());
    const std::size_t count = meshopt_generateVertexRemap(
        position.data(), nullptr, positions.size(), positions.data(), positions.size(), sizeof(glm::vec3));
    const Groups vertices_at(position, count);
    for (std::uint32_t p = 0; p < count; ++p)
        for (const std::uint32_t vertex : vertices_at.of(p))
            for (const std::uint32_t first : vertices_at.of(p)) {
                group[vertex] = first;
                if (first == vertex || glm::dot(normals[first], normals[vertex]) > min_same_normal_cosine)
                    break;
            }
    return group;
}

// Assigns original or added vertices to the corners of a simplified mesh.
class VertexRestorer {
  public:
    VertexRestorer(const WeldedMesh& mesh, std::span<const glm::vec3> positions,
                   std::span<const glm::vec3> normals, const LevelOptions& options)
        : mesh_(mesh),
          normals_(normals),
          options_(options),
          smooth_group_(smooth_groups(positions, normals)),
          vertices_at_(mesh.position_of, mesh.positions.size()) {}

    // Before the call, `level.indices` refer to the welded positions; afterwards, to the original and the
    // added vertices.
    void restore(LevelOfDetail& level) const {
        const std::vector<std::uint32_t>& corners = level.indices;
        std::vector<glm::vec3> areas, faces;
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const glm::vec3& a = mesh_.positions[corners[i]];
            areas.push_back(
                glm::cross(mesh_.positions[corners[i + 1]] - a, mesh_.positions[corners[i + 2]] - a));
            const float length = glm::length(areas.back());
            faces.push_back(length > 0.0F ? areas.back() / length : glm::vec3(0.0F));
        }
        std::vector<std::uint32_t> vertices(corners.size());
        std::vector<std::uint32_t> group(corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            vertices[i] = vertex_for(corners[i], faces[i / 3]);
            group[i] = smooth_group_[vertices[i]];
        }
        const Groups corners_of(group, normals_.size());
        const float min_crease_cosine = std::cos(options_.crease),
                    min_normal_cosine = std::cos(options_.max_normal_error);
        // Added vertices, by original vertex.
        std::vector<std::vector<std::uint32_t>> copies(normals_.size());
        std::vector<std::uint32_t> indices(corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t vertex = vertices[i];
            glm::vec3 sum(0.0F);
            for (const std::uint32_t corner : corners_of.of(group[i]))
                if (glm::dot(faces[corner / 3], faces[i / 3]) > min_crease_cosine) sum += areas[corner / 3];
            const float length = glm::length(sum);
            const glm::vec3 normal = length > 0.0F ? sum / length : normals_[vertex];
            indices[i] = glm::dot(normal, normals_[vertex]) > min_normal_cosine
                             ? vertex
                             : added_vertex(level, copies[vertex], vertex, normal);
        }
        level.indices = std::move(indices);
    }

  private:
    // Returns the vertex at a position whose normal is nearest to a face's normal; the first of nearly equal
    // ones.
    std::uint32_t vertex_for(std::uint32_t position, const glm::vec3& face) const {
        const std::span<const std::uint32_t> vertices = vertices_at_.of(position);
        std::uint32_t best = vertices.front();
        float best_cosine = glm::dot(normals_[best], face);
        for (const std::uint32_t vertex : vertices) {
            const float cosine = glm::dot(normals_[vertex], face);
            if (cosine > best_cosine + 1e-3F) {
                best_cosine = cosine;
                best = vertex;
            }
        }
        return best;
    }

    // Returns the index of an added copy of `vertex` with this normal, and creates it if `copies` has none.
    std::uint32_t added_vertex(LevelOfDetail& level, std::vector<std::uint32_t>& copies, std::uint32_t vertex,
                               const glm::vec3& normal) const {
        for (const std::uint32_t known : copies)
            if (glm::dot(level.added[known].normal, normal) > min_same_normal_cosine)
                return static_cast<std::uint32_t>(normals_.size()) + known;
        copies.push_back(static_cast<std::uint32_t>(level.added.size()));
        level.added.push_back({vertex, normal});
        return static_cast<std::uint32_t>(normals_.size()) + copies.back();
    }

    const WeldedMesh& mesh_;
    std::span<const glm::vec3> normals_;
    const LevelOptions& options_;
    std::vector<std::uint32_t> smooth_group_;
    Groups vertices_at_;  // vertices at each position
};

}  // namespace

std::vector<LevelOfDetail> coarser_levels(std::span<const glm::vec3> positions,
                                          std::span<const glm::vec3> normals,
                                          std::span<const std::uint32_t> indices,
                                          const LevelOptions& options) {
    std::vector<LevelOfDetail> levels;
    if (positions.empty() || indices.size() < options.min_indices) return levels;
    const bool has_normals = !normals.empty();
    const WeldedMesh mesh = weld_mesh(positions, indices, has_normals && options.weld);
    const VertexRestorer restorer(mesh, positions.first(normals.size()), normals, options);
    const float* first = &mesh.positions.front().x;
    const float size = meshopt_simplifyScale(first, mesh.positions.size(), sizeof(glm::vec3));
    std::vector<std::uint32_t> previous = mesh.indices;
    float error = 0.0F;  // accumulated over the steps
    while (levels.size() < options.levels && previous.size() >= options.min_indices) {
        std::vector<std::uint32_t> simplified(previous.size());
        float relative_error = 0.0F;
        simplified.resize(meshopt_simplify(simplified.data(), previous.data(), previous.size(), first,
                                           mesh.positions.size(), sizeof(glm::vec3), previous.size() / 6 * 3,
                                           options.max_error, 0, &relative_error));
        const auto max_size =
            static_cast<std::size_t>(options.max_ratio * static_cast<float>(previous.size()));
        if (simplified.empty() || simplified.size() > max_size) break;
        error += relative_error * size;
        LevelOfDetail level{simplified, {}, error};
        if (has_normals) restorer.restore(level);
        meshopt_optimizeVertexCache(level.indices.data(), level.indices.data(), level.indices.size(),
                                    positions.size() + level.added.size());
        levels.push_back(std::move(level));
        previous = std::move(simplified);
    }
    return levels;
}

}  // namespace bolt::assets
