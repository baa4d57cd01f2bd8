#include "haptics/collision/triangle_octree.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

namespace bolt::collision {
namespace {

constexpr int levels = octree_levels;
const double half_diagonal = 0.5 * std::sqrt(3.0);  // of a cell of size 1
// Places whose normals spread further have no use of their plane (rad).
constexpr float upright = 1.3F;
// A cell with so few triangles is not divided further if they are nearly in a plane, or are next to none.
constexpr std::size_t few = 8;
constexpr std::size_t next_to_none = 10;
const double flat = std::cos(to_radians(3.0));
// More than what coordinates in float are off by (m).
constexpr double rounding = 1e-6;
// Higher than this above each other's planes are triangles of a place that is not convex (m).
constexpr double hardly_above = 0.4 * plane_tolerance;
constexpr std::size_t most_for_convex = 128;

class Builder {
  public:
    Builder(const Solid& solid, TriangleOctree& made) : solid_(solid), made_(made) {}

    // `within`: the surface is not further from the middle.
    void fill(std::size_t node, std::span<const std::uint32_t> among, const Vec3& middle, double size,
              int level, double within) {
        std::vector<std::uint32_t> here;
        for (const std::uint32_t t : among)
            if (within_reach(t, middle, 0.5 * size)) here.push_back(t);
        const double distance = query_point(solid_, middle, within, 0.0, {}).distance;
        made_.nodes[node].distance = static_cast<float>(distance);
        OctreeLeaf leaf = describe(here);
        const bool plain = here.size() <= next_to_none ||
                           (here.size() <= few && std::cos(static_cast<double>(leaf.spread)) > flat);
        // Where nothing is listed, a cell whose corners are known to be clear by some of its size is good
        // enough.
        const bool clear = std::abs(distance) > 1.25 * half_diagonal * size;
        if (level == levels || (here.empty() ? clear : plain)) {
            if (here.empty()) return;
            if (here.size() > max_listed) here.clear();
            leaf.begin = static_cast<std::uint32_t>(made_.triangles.size());
            made_.triangles.insert(made_.triangles.end(), here.begin(), here.end());
            leaf.end = static_cast<std::uint32_t>(made_.triangles.size());
            add_boxes(here, leaf);
            leaf.convex = is_single(here) && (is_even(here, leaf.spread) || is_convex(here));
            leaf.front =
                !here.empty() && leaf.spread < upright && is_outside_before(leaf, middle, size, distance);
            made_.nodes[node].next = -static_cast<std::int32_t>(made_.leaves.size());
            made_.leaves.push_back(leaf);
            return;
        }
        const std::size_t first = made_.nodes.size();
        made_.nodes[node].next = static_cast<std::int32_t>(first);
        made_.nodes.resize(first + 8, {0.0F, 0});
        const double quarter = 0.25 * size;
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 child = middle + quarter * Vec3(i & 1U ? 1 : -1, i & 2U ? 1 : -1, i & 4U ? 1 : -1);
            fill(first + i, here, child, 0.5 * size, level + 1,
                 std::abs(distance) + glm::length(child - middle) + made_.rounding);
        }
    }

  private:
    // Whether the triangle may be within reach of the cell: by its box and by its plane.
    [[nodiscard]] bool within_reach(std::uint32_t t, const Vec3& middle, double half) const {
        const auto& c = solid_.corners[t];
        const Vec3 low(glm::min(glm::min(c[0], c[1]), c[2]));
        const Vec3 high(glm::max(glm::max(c[0], c[1]), c[2]));
        constexpr double reach = octree_reach + rounding;
        const Vec3 beside = glm::max(glm::max(low - middle, middle - high) - half, Vec3(0.0));
        if (glm::dot(beside, beside) > reach * reach) return false;
        const Vec3 normal(solid_.mesh.face_normals[t]);
        const Vec3 size = glm::abs(normal);
        return std::abs(glm::dot(normal, middle - Vec3(c[0]))) <= half * (size.x + size.y + size.z) + reach;
    }

    void add_boxes(std::span<const std::uint32_t> here, OctreeLeaf& leaf) {
        leaf.boxes = static_cast<std::uint32_t>(made_.boxes.size());
        for (int side = 0; side < 2; ++side)
            for (int k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < (here.size() + 3) / 4 * 4; ++i) {
                    constexpr float nowhere = 1e9F;
                    if (i >= here.size()) {
                        made_.boxes.push_back(nowhere);
                        continue;
                    }
                    const auto& c = solid_.corners[here[i]];
                    made_.boxes.push_back(side == 0 ? std::min({c[0][k], c[1][k], c[2][k]})
                                                    : std::max({c[0][k], c[1][k], c[2][k]}));
                }
    }

    // What of the cell is before the plane is met by no surface: what is true of one of its points is true of
    // all.
    [[nodiscard]] bool is_outside_before(const OctreeLeaf& leaf, const Vec3& middle, double size,
                                         double distance) const {
        if (glm::dot(leaf.normal, middle) > leaf.height) return distance > 0.0;
        const Vec3 way = glm::mix(Vec3(-1.0), Vec3(1.0), glm::greaterThan(leaf.normal, Vec3(0.0)));
        const Vec3 corner = middle + 0.5 * size * way;
        if (!(glm::dot(leaf.normal, corner) > leaf.height)) return false;
        return query_point(solid_, corner, infinite_distance, 0.0, {}).distance > 0.0;
    }

    [[nodiscard]] OctreeLeaf describe(std::span<const std::uint32_t> here) const {
        OctreeLeaf leaf;
        leaf.spread = static_cast<float>(pi);
        Vec3 sum(0.0);
        for (const std::uint32_t t : here) sum += Vec3(solid_.mesh.face_normals[t]);
        if (!(glm::length(sum) > 1e-3)) return leaf;
        leaf.normal = glm::normalize(sum);
        double least = 1.0;
        leaf.height = -infinite_distance;
        for (const std::uint32_t t : here) {
            least = std::min(least, glm::dot(leaf.normal, Vec3(solid_.mesh.face_normals[t])));
            for (const glm::vec3& v : solid_.corners[t])
                leaf.height = std::max(leaf.height, glm::dot(leaf.normal, Vec3(v)));
        }
        leaf.height += 1e-9;
        leaf.spread = static_cast<float>(std::acos(std::clamp(least, -1.0, 1.0)) + 1e-4);
        return leaf;
    }

    [[nodiscard]] bool is_single(std::span<const std::uint32_t> here) const {
        return std::all_of(here.begin(), here.end(),
                           [&](std::uint32_t t) { return solid_.part[t] == solid_.part[here[0]]; });
    }

    // Whether the triangles are one sheet (of a closed surface all would be listed that part two, or lead
    // from one to the other), of which nothing that is as near as reach to a point rises above what else is
    // by as much as gets a side of its own.
    [[nodiscard]] bool is_even(std::span<const std::uint32_t> here, float spread) const {
        constexpr double steepest = 0.9 * plane_tolerance / (2.0 * octree_reach);  // rad, between two of them
        if (solid_.mesh.open_edges > 0 || static_cast<double>(spread) > steepest) return false;
        const double least = 1.0 - 0.5 * steepest * steepest;
        for (const std::uint32_t a : here)
            for (const std::uint32_t b : here)
                if (glm::dot(Vec3(solid_.mesh.face_normals[a]), Vec3(solid_.mesh.face_normals[b])) < least)
                    return false;
        return true;
    }

    [[nodiscard]] bool is_convex(std::span<const std::uint32_t> here) const {
        if (here.size() > most_for_convex) return false;
        for (const std::uint32_t t : here) {
            const Vec3 normal(solid_.mesh.face_normals[t]);
            const double height = glm::dot(normal, Vec3(solid_.corners[t][0])) + hardly_above;
            for (const std::uint32_t other : here)
                for (const glm::vec3& v : solid_.corners[other])
                    if (glm::dot(normal, Vec3(v)) > height) return false;
        }
        return true;
    }

    const Solid& solid_;
    TriangleOctree& made_;
};

}  // namespace

TriangleOctree make_triangle_octree(const Solid& solid, double cell) {
    TriangleOctree made;
    if (!(cell > 0.0)) return made;
    made.root = cell * (1 << levels);
    made.per_root = 1.0 / made.root;
    for (std::size_t i = 0; i < made.sizes.size(); ++i)
        made.sizes[i] = std::ldexp(made.root, -static_cast<int>(i));
    made.low = solid.box.low - made.root;
    const Vec3 size = (solid.box.high - solid.box.low) / made.root;
    made.rounding = 1e-6 * (1.0 + glm::length(solid.box.high - solid.box.low) + 8.0 * made.root);
    for (int k = 0; k < 3; ++k)
        made.roots[static_cast<std::size_t>(k)] = static_cast<int>(std::ceil(size[k])) + 2;
    const auto [nx, ny, nz] = made.roots;
    std::vector<std::vector<std::uint32_t>> among(static_cast<std::size_t>(nx * ny * nz));
    for (std::uint32_t t = 0; t < solid.corners.size(); ++t) {
        const auto& c = solid.corners[t];
        const Vec3 low(glm::min(glm::min(c[0], c[1]), c[2]));
        const Vec3 high(glm::max(glm::max(c[0], c[1]), c[2]));
        const glm::ivec3 from((low - octree_reach - rounding - made.low) / made.root);
        const glm::ivec3 to((high + octree_reach + rounding - made.low) / made.root);
        for (int z = std::max(0, from.z); z <= std::min(nz - 1, to.z); ++z)
            for (int y = std::max(0, from.y); y <= std::min(ny - 1, to.y); ++y)
                for (int x = std::max(0, from.x); x <= std::min(nx - 1, to.x); ++x)
                    among[static_cast<std::size_t>((z * ny + y) * nx + x)].push_back(t);
    }
    made.nodes.resize(among.size(), {0.0F, 0});
    made.leaves.emplace_back();
    Builder builder(solid, made);
    std::size_t node = 0;
    for (int z = 0; z < nz; ++z)
        for (int y = 0; y < ny; ++y)
            for (int x = 0; x < nx; ++x, ++node)
                builder.fill(node, among[node], made.low + made.root * (Vec3(x, y, z) + 0.5), made.root, 0,
                             infinite_distance);
    return made;
}

namespace {

// The leaf that holds a point; its node is null beyond the octree.
OctreeCursor find_leaf(const TriangleOctree& octree, const Vec3& from_low) {
    const Vec3 at = from_low * octree.per_root;
    for (int k = 0; k < 3; ++k)
        if (!(at[k] >= 0.0 && at[k] < static_cast<double>(octree.roots[static_cast<std::size_t>(k)])))
            return {};
    const glm::ivec3 cell(at);
    const TriangleOctree::Node* node =
        &octree
             .nodes[static_cast<std::size_t>((cell.z * octree.roots[1] + cell.y) * octree.roots[0] + cell.x)];
    // In which of the smallest cells of the root cell, bit by bit from above.
    const glm::ivec3 fine((at - Vec3(cell)) * static_cast<double>(1 << levels));
    int level = 0;
    while (node->next > 0) {
        const int shift = levels - 1 - level++;
        const int child = (fine.x >> shift & 1) | (fine.y >> shift & 1) << 1 | (fine.z >> shift & 1) << 2;
        node = &octree.nodes[static_cast<std::size_t>(node->next + child)];
    }
    const double size = octree.sizes[static_cast<std::size_t>(level)];
    const int rest = levels - level;
    const Vec3 whole(fine.x >> rest, fine.y >> rest, fine.z >> rest);
    return {octree.root * Vec3(cell) + size * (whole + 0.5), 0.5 * size, node};
}

}  // namespace

OctreeQuery query(const TriangleOctree& octree, const Vec3& point) {
    OctreeCursor none;
    return query(octree, point, none);
}

OctreeQuery query(const TriangleOctree& octree, const Vec3& point, OctreeCursor& last) {
    if (octree.nodes.empty()) return {};
    const Vec3 from_low = point - octree.low;
    Vec3 off = from_low - last.middle;
    const auto is_in = [&] {
        return std::abs(off.x) < last.half && std::abs(off.y) < last.half && std::abs(off.z) < last.half;
    };
    if (!is_in()) {
        last = find_leaf(octree, from_low);
        if (last.node == nullptr) return {};
        off = from_low - last.middle;
    }
    const TriangleOctree::Node* node = last.node;
    const double half = last.half;
    const double way = glm::length(off) + octree.rounding;
    const auto distance = static_cast<double>(node->distance);
    OctreeQuery seen{distance - way, std::abs(distance) + way, nullptr, 0.0};
    const Vec3 inward = half - glm::abs(off);
    const double unlisted = std::min({inward.x, inward.y, inward.z}) + octree_reach - octree.rounding;
    seen.unlisted = unlisted;
    if (node->next == 0) {
        if (distance > 0.0) seen.lower = std::max(seen.lower, unlisted);
        return seen;
    }
    seen.leaf = &octree.leaves[static_cast<std::size_t>(-node->next)];
    if (seen.leaf->begin == seen.leaf->end) {
        seen.leaf = nullptr;
        return seen;
    }
    const double above = glm::dot(seen.leaf->normal, point) - seen.leaf->height;
    if (seen.leaf->front && above > 0.0) seen.lower = std::max(seen.lower, std::min(above, unlisted));
    return seen;
}

}  // namespace bolt::collision
