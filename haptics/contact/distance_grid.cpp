#include "haptics/contact/distance_grid.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::contact {
namespace {

constexpr int levels = 4;
// More than what a float distance is off by, at a metre.
constexpr double rounding = 1e-6;
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
                 std::abs(distance) + glm::length(child - middle) + rounding);
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
    const Vec3 size = (solid.box.high - solid.box.low) / grid.root;
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
    const Vec3 at = (point - grid.low) / grid.root;
    for (std::size_t k = 0; k < 3; ++k) {
        const double x = at[static_cast<int>(k)];
        if (!(x >= 0.0 && x < grid.roots[k])) return {};
    }
    const int x = static_cast<int>(at.x);
    const int y = static_cast<int>(at.y);
    const int z = static_cast<int>(at.z);
    const DistanceGrid::Node* node =
        &grid.nodes[static_cast<std::size_t>((z * grid.roots[1] + y) * grid.roots[0] + x)];
    Vec3 from_middle = point - (grid.low + grid.root * (Vec3(x, y, z) + 0.5));
    double quarter = 0.25 * grid.root;
    while (node->children != 0) {
        const bool right = from_middle.x >= 0.0;
        const bool up = from_middle.y >= 0.0;
        const bool front = from_middle.z >= 0.0;
        node = &grid.nodes[node->children + (right ? 1U : 0U) + (up ? 2U : 0U) + (front ? 4U : 0U)];
        from_middle -= quarter * Vec3(right ? 1 : -1, up ? 1 : -1, front ? 1 : -1);
        quarter *= 0.5;
    }
    const double off = glm::length(from_middle) + rounding;
    const auto distance = static_cast<double>(node->distance);
    return {distance - off, std::abs(distance) + off};
}

}  // namespace bolt::contact
