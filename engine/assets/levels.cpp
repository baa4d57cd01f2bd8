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

// The mesh without seams: one vertex per position; without welding, one per vertex.
struct WeldedMesh {
    std::vector<glm::vec3> positions;
    std::vector<std::uint32_t> position_of;  // for each vertex, its position
    std::vector<std::uint32_t> indices;      // of positions
};

WeldedMesh weld_mesh(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices,
                     bool weld) {
    WeldedMesh shape;
    shape.position_of.resize(positions.size());
    std::iota(shape.position_of.begin(), shape.position_of.end(), 0U);
    std::size_t count = positions.size();
    if (weld)
        count = meshopt_generateVertexRemap(shape.position_of.data(), nullptr, positions.size(),
                                            positions.data(), positions.size(), sizeof(glm::vec3));
    shape.positions.resize(count);
    for (std::size_t i = 0; i < positions.size(); ++i) shape.positions[shape.position_of[i]] = positions[i];
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = shape.position_of[indices[i]], b = shape.position_of[indices[i + 1]],
                            c = shape.position_of[indices[i + 2]];
        if (a != b && b != c && c != a) shape.indices.insert(shape.indices.end(), {a, b, c});
    }
    return shape;
}

constexpr float same_normal = 0.99965732F;  // cos 1.5°

// For each vertex, the first vertex with the same position and normal: there is no edge between them.
std::vector<std::uint32_t> smooth_of(std::span<const glm::vec3> positions,
                                     std::span<const glm::vec3> normals) {
    std::vector<std::uint32_t> position(positions.size()), smooth(positions.size());
    const std::size_t count = meshopt_generateVertexRemap(
        position.data(), nullptr, positions.size(), positions.data(), positions.size(), sizeof(glm::vec3));
    const Groups vertices_at(position, count);
    for (std::uint32_t p = 0; p < count; ++p)
        for (const std::uint32_t vertex : vertices_at.of(p))
            for (const std::uint32_t first : vertices_at.of(p)) {
                smooth[vertex] = first;
                if (first == vertex || glm::dot(normals[first], normals[vertex]) > same_normal) break;
            }
    return smooth;
}

// Assigns vertices and normals to the corners of a simplified mesh.
class VertexRestorer {
  public:
    VertexRestorer(const WeldedMesh& shape, std::span<const glm::vec3> positions,
                   std::span<const glm::vec3> normals, const LevelOptions& options)
        : shape_(shape),
          normals_(normals),
          options_(options),
          smooth_(smooth_of(positions, normals)),
          vertices_at_(shape.position_of, shape.positions.size()) {}

    void dress(LevelOfDetail& level) const {
        const std::vector<std::uint32_t>& corners = level.indices;
        std::vector<glm::vec3> areas, faces;
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const glm::vec3& a = shape_.positions[corners[i]];
            areas.push_back(
                glm::cross(shape_.positions[corners[i + 1]] - a, shape_.positions[corners[i + 2]] - a));
            const float length = glm::length(areas.back());
            faces.push_back(length > 0.0F ? areas.back() / length : glm::vec3(0.0F));
        }
        std::vector<std::uint32_t> vertices(corners.size());
        std::vector<std::uint32_t> smooth(corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            vertices[i] = vertex_for(corners[i], faces[i / 3]);
            smooth[i] = smooth_[vertices[i]];
        }
        const Groups around(smooth, normals_.size());
        const float same_side = std::cos(options_.crease), fits = std::cos(options_.max_normal_error);
        std::vector<std::vector<std::uint32_t>> made(normals_.size());  // added vertices, by original vertex
        std::vector<std::uint32_t> indices(corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t vertex = vertices[i];
            glm::vec3 sum(0.0F);
            for (const std::uint32_t corner : around.of(smooth[i]))
                if (glm::dot(faces[corner / 3], faces[i / 3]) > same_side) sum += areas[corner / 3];
            const float length = glm::length(sum);
            const glm::vec3 normal = length > 0.0F ? sum / length : normals_[vertex];
            indices[i] = glm::dot(normal, normals_[vertex]) > fits
                             ? vertex
                             : added_vertex(level, made[vertex], vertex, normal);
        }
        level.indices = std::move(indices);
    }

  private:
    // Returns the vertex at a position whose normal is nearest to a face's normal; the first one of equals.
    std::uint32_t vertex_for(std::uint32_t position, const glm::vec3& face) const {
        const std::span<const std::uint32_t> vertices = vertices_at_.of(position);
        std::uint32_t best = vertices.front();
        float most = glm::dot(normals_[best], face);
        for (const std::uint32_t vertex : vertices) {
            const float alike = glm::dot(normals_[vertex], face);
            if (alike > most + 1e-3F) {
                most = alike;
                best = vertex;
            }
        }
        return best;
    }

    std::uint32_t added_vertex(LevelOfDetail& level, std::vector<std::uint32_t>& made, std::uint32_t vertex,
                               const glm::vec3& normal) const {
        for (const std::uint32_t known : made)
            if (glm::dot(level.added[known].normal, normal) > same_normal)
                return static_cast<std::uint32_t>(normals_.size()) + known;
        made.push_back(static_cast<std::uint32_t>(level.added.size()));
        level.added.push_back({vertex, normal});
        return static_cast<std::uint32_t>(normals_.size()) + made.back();
    }

    const WeldedMesh& shape_;
    std::span<const glm::vec3> normals_;
    const LevelOptions& options_;
    std::vector<std::uint32_t> smooth_;
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
    const WeldedMesh shape = weld_mesh(positions, indices, has_normals && options.weld);
    const VertexRestorer dresser(shape, positions.first(normals.size()), normals, options);
    const float* first = &shape.positions.front().x;
    const float size = meshopt_simplifyScale(first, shape.positions.size(), sizeof(glm::vec3));
    std::vector<std::uint32_t> from = shape.indices;
    float error = 0.0F;  // accumulated over the steps
    while (levels.size() < options.levels && from.size() >= options.min_indices) {
        std::vector<std::uint32_t> kept(from.size());
        float reached = 0.0F;
        kept.resize(meshopt_simplify(kept.data(), from.data(), from.size(), first, shape.positions.size(),
                                     sizeof(glm::vec3), from.size() / 6 * 3, options.max_error, 0, &reached));
        const auto max_ratio = static_cast<std::size_t>(options.max_ratio * static_cast<float>(from.size()));
        if (kept.empty() || kept.size() > max_ratio) break;
        error += reached * size;
        LevelOfDetail level{kept, {}, error};
        if (has_normals) dresser.dress(level);
        meshopt_optimizeVertexCache(level.indices.data(), level.indices.data(), level.indices.size(),
                                    positions.size() + level.added.size());
        levels.push_back(std::move(level));
        from = std::move(kept);
    }
    return levels;
}

}  // namespace bolt::assets
