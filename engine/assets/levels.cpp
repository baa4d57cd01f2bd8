#include "engine/assets/levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <numeric>

namespace bolt::assets {

namespace {

// Things by a number that many share, one after the other.
struct Groups {
    std::vector<std::uint32_t> first;  // one more than there are groups
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

// The mesh as a shape: vertices at one place are one, or, not welded, each stands for itself.
struct Shape {
    std::vector<glm::vec3> places;
    std::vector<std::uint32_t> place_of;  // each vertex
    std::vector<std::uint32_t> indices;   // of places
};

Shape shape_of(std::span<const glm::vec3> positions, std::span<const std::uint32_t> indices, bool weld) {
    Shape shape;
    shape.place_of.resize(positions.size());
    std::iota(shape.place_of.begin(), shape.place_of.end(), 0U);
    std::size_t count = positions.size();
    if (weld)
        count = meshopt_generateVertexRemap(shape.place_of.data(), nullptr, positions.size(),
                                            positions.data(), positions.size(), sizeof(glm::vec3));
    shape.places.resize(count);
    for (std::size_t i = 0; i < positions.size(); ++i) shape.places[shape.place_of[i]] = positions[i];
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = shape.place_of[indices[i]], b = shape.place_of[indices[i + 1]],
                            c = shape.place_of[indices[i + 2]];
        if (a != b && b != c && c != a) shape.indices.insert(shape.indices.end(), {a, b, c});
    }
    return shape;
}

constexpr float same_normal = 0.99965732F;  // cos 1.5°

// For each vertex the first one at the same place with the same normal: between them there is no edge.
std::vector<std::uint32_t> smooth_of(std::span<const glm::vec3> positions,
                                     std::span<const glm::vec3> normals) {
    std::vector<std::uint32_t> place(positions.size()), smooth(positions.size());
    const std::size_t places = meshopt_generateVertexRemap(
        place.data(), nullptr, positions.size(), positions.data(), positions.size(), sizeof(glm::vec3));
    const Groups there(place, places);
    for (std::uint32_t p = 0; p < places; ++p)
        for (const std::uint32_t vertex : there.of(p))
            for (const std::uint32_t first : there.of(p)) {
                smooth[vertex] = first;
                if (first == vertex || glm::dot(normals[first], normals[vertex]) > same_normal) break;
            }
    return smooth;
}

// Gives a simplified shape its vertices and normals back.
class Dresser {
  public:
    Dresser(const Shape& shape, std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
            const LevelOptions& options)
        : shape_(shape),
          normals_(normals),
          options_(options),
          smooth_(smooth_of(positions, normals)),
          there_(shape.place_of, shape.places.size()) {}

    void dress(Level& level) const {
        const std::vector<std::uint32_t>& corners = level.indices;
        std::vector<glm::vec3> areas, faces;
        for (std::size_t i = 0; i + 2 < corners.size(); i += 3) {
            const glm::vec3& a = shape_.places[corners[i]];
            areas.push_back(glm::cross(shape_.places[corners[i + 1]] - a, shape_.places[corners[i + 2]] - a));
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
        const float least = std::cos(options_.crease), fits = std::cos(options_.turned);
        std::vector<std::vector<std::uint32_t>> made(normals_.size());  // added ones, by vertex
        std::vector<std::uint32_t> indices(corners.size());
        for (std::size_t i = 0; i < corners.size(); ++i) {
            const std::uint32_t vertex = vertices[i];
            glm::vec3 sum(0.0F);
            for (const std::uint32_t corner : around.of(smooth[i]))
                if (glm::dot(faces[corner / 3], faces[i / 3]) > least) sum += areas[corner / 3];
            const float length = glm::length(sum);
            const glm::vec3 normal = length > 0.0F ? sum / length : normals_[vertex];
            indices[i] = glm::dot(normal, normals_[vertex]) > fits
                             ? vertex
                             : added_vertex(level, made[vertex], vertex, normal);
        }
        level.indices = std::move(indices);
    }

  private:
    // Of those at a place, the one that looks most like a face; the first of those that look alike.
    std::uint32_t vertex_for(std::uint32_t place, const glm::vec3& face) const {
        const std::span<const std::uint32_t> vertices = there_.of(place);
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

    std::uint32_t added_vertex(Level& level, std::vector<std::uint32_t>& made, std::uint32_t vertex,
                               const glm::vec3& normal) const {
        for (const std::uint32_t known : made)
            if (glm::dot(level.added[known].normal, normal) > same_normal)
                return static_cast<std::uint32_t>(normals_.size()) + known;
        made.push_back(static_cast<std::uint32_t>(level.added.size()));
        level.added.push_back({vertex, normal});
        return static_cast<std::uint32_t>(normals_.size()) + made.back();
    }

    const Shape& shape_;
    std::span<const glm::vec3> normals_;
    const LevelOptions& options_;
    std::vector<std::uint32_t> smooth_;
    Groups there_;  // vertices at each place
};

}  // namespace

std::vector<Level> coarser_levels(std::span<const glm::vec3> positions, std::span<const glm::vec3> normals,
                                  std::span<const std::uint32_t> indices, const LevelOptions& options) {
    std::vector<Level> levels;
    if (positions.empty() || indices.size() < options.least) return levels;
    const bool dressed = !normals.empty();
    const Shape shape = shape_of(positions, indices, dressed && options.weld);
    const Dresser dresser(shape, positions.first(normals.size()), normals, options);
    const float* first = &shape.places.front().x;
    const float size = meshopt_simplifyScale(first, shape.places.size(), sizeof(glm::vec3));
    std::vector<std::uint32_t> from = shape.indices;
    float error = 0.0F;  // errors of steps add up
    while (levels.size() < options.levels && from.size() >= options.least) {
        std::vector<std::uint32_t> kept(from.size());
        float reached = 0.0F;
        kept.resize(meshopt_simplify(kept.data(), from.data(), from.size(), first, shape.places.size(),
                                     sizeof(glm::vec3), from.size() / 6 * 3, options.most_error, 0,
                                     &reached));
        const auto worthwhile =
            static_cast<std::size_t>(options.worthwhile * static_cast<float>(from.size()));
        if (kept.empty() || kept.size() > worthwhile) break;
        error += reached * size;
        Level level{kept, {}, error};
        if (dressed) dresser.dress(level);
        meshopt_optimizeVertexCache(level.indices.data(), level.indices.data(), level.indices.size(),
                                    positions.size() + level.added.size());
        levels.push_back(std::move(level));
        from = std::move(kept);
    }
    return levels;
}

}  // namespace bolt::assets
