#include "haptics/contact/distance_grid.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::contact {
namespace {

constexpr int levels = 4;
const double half_diagonal = 0.5 * std::sqrt(3.0);  // of a cell of size 1

class Builder {
  public:
    Builder(const Solid& solid, DistanceGrid& grid) : solid_(solid), grid_(grid) {}

    void fill(std::uint32_t node, const Vec3& middle, double size, int level, double within) {
        const double distance = near_point(solid_, middle, within, 0.0, {}).distance;
        grid_.nodes[node].distance = static_cast<float>(distance);
        // A cell whose corners are known to be clear by some of its size is good enough.
        if (level == levels || std::abs(distance) > 1.25 * half_diagonal * size) return;
        const auto first = static_cast<std::uint32_t>(grid_.nodes.size());
        grid_.nodes[node].children = first;
        grid_.nodes.resize(grid_.nodes.size() + 8, {0.0F, 0});
        const double quarter = 0.25 * size;
        for (std::uint32_t i = 0; i < 8; ++i) {
            const Vec3 child = middle + quarter * Vec3(i & 1U ? 1 : -1, i & 2U ? 1 : -1, i & 4U ? 1 : -1);
            fill(first + i, child, 0.5 * size, level + 1,
                 std::abs(distance) + glm::length(child - middle) + grid_.rounding);
        }
    }

  private:
    const Solid& solid_;
    DistanceGrid& grid_;
};

}  // namespace

DistanceGrid make_distance_grid(const Solid& solid, double cell) {
    DistanceGrid grid;
    if (!(cell > 0.0)) return grid;
    grid.root = cell * (1 << levels);
    grid.low = solid.box.low - grid.root;
    grid.per_root = static_cast<float>(1.0 / grid.root);
    const Vec3 size = (solid.box.high - solid.box.low) / grid.root;
    grid.rounding = 1e-6 * (1.0 + glm::length(solid.box.high - solid.box.low) + 8.0 * grid.root);
    std::size_t count = 1;
    for (std::size_t k = 0; k < 3; ++k) {
        grid.roots[k] = static_cast<int>(std::ceil(size[static_cast<int>(k)])) + 2;
        count *= static_cast<std::size_t>(grid.roots[k]);
    }
    grid.nodes.resize(count, {0.0F, 0});
    Builder builder(solid, grid);
    std::uint32_t node = 0;
    for (int z = 0; z < grid.roots[2]; ++z)
        for (int y = 0; y < grid.roots[1]; ++y)
            for (int x = 0; x < grid.roots[0]; ++x)
                builder.fill(node++, grid.low + grid.root * (Vec3(x, y, z) + 0.5), grid.root, 0,
                             nothing_near);
    return grid;
}

DistanceBounds distance_bounds(const DistanceGrid& grid, const Vec3& point) {
    if (grid.nodes.empty()) return {};
    const glm::vec3 from_low(point - grid.low);
    const glm::vec3 at = from_low * grid.per_root;
    for (int k = 0; k < 3; ++k)
        if (!(at[k] >= 0.0F && at[k] < static_cast<float>(grid.roots[static_cast<std::size_t>(k)])))
            return {};
    const glm::ivec3 cell(at);
    const auto size = static_cast<float>(grid.root);
    glm::vec3 off = from_low - size * (glm::vec3(cell) + 0.5F);
    const DistanceGrid::Node* node =
        &grid.nodes[static_cast<std::size_t>((cell.z * grid.roots[1] + cell.y) * grid.roots[0] + cell.x)];
    for (float quarter = 0.25F * size; node->children != 0; quarter *= 0.5F) {
        const bool x = off.x >= 0.0F;
        const bool y = off.y >= 0.0F;
        const bool z = off.z >= 0.0F;
        node = &grid.nodes[node->children + (x ? 1U : 0U) + (y ? 2U : 0U) + (z ? 4U : 0U)];
        off -= glm::vec3(x ? quarter : -quarter, y ? quarter : -quarter, z ? quarter : -quarter);
    }
    const double way = static_cast<double>(glm::length(off)) + grid.rounding;
    const auto distance = static_cast<double>(node->distance);
    return {distance - way, std::abs(distance) + way};
}

}  // namespace bolt::contact
