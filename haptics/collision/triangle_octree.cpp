#include "haptics/collision/triangle_octree.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <iterator>
#include <utility>

#include "engine/base/parallel.hpp"

namespace bolt::collision {
namespace {

constexpr int levels = octree_levels;
const double half_diagonal = 0.5 * std::sqrt(3.0);  // of a cell of size 1
// rad; a leaf whose normals spread further does not use its plane.
constexpr float max_leaf_spread = 1.3F;
constexpr std::size_t few_triangles = 10;  // a cell with at most so many is not divided
// m; exceeds the error of coordinates in float.
constexpr double octree_rounding = 1e-6;
// m; a leaf is not convex if a triangle rises by more than this above another's plane.
constexpr double convexity_tolerance = 0.4 * plane_tolerance;
constexpr std::size_t max_convexity_test = 128;

using Float4 [[gnu::vector_size(16)]] = float;

// Box and plane of a triangle.
struct TriangleBounds {
    Float4 low, high;
    glm::vec3 normal, corner;
};

std::vector<TriangleBounds> triangle_bounds(const Solid& solid) {
    std::vector<TriangleBounds> bounds;
    bounds.reserve(solid.corners.size());
    for (std::size_t t = 0; t < solid.corners.size(); ++t) {
        const auto& c = solid.corners[t];
        const glm::vec3 low = glm::min(glm::min(c[0], c[1]), c[2]);
        const glm::vec3 high = glm::max(glm::max(c[0], c[1]), c[2]);
        bounds.push_back(
            {Float4{low.x, low.y, low.z}, Float4{high.x, high.y, high.z}, solid.mesh.face_normals[t], c[0]});
    }
    return bounds;
}

// Fills octrees of a single root cell: node 0.
class CellBuilder {
  public:
    // `bounds`: by triangle.
    CellBuilder(const Solid& solid, std::span<const TriangleBounds> bounds, TriangleOctree& octree)
        : solid_(solid), bounds_(bounds), octree_(octree) {}

    // Fills a node and its children. `candidates`: triangles that may be within reach of the cell. `within`:
    // m, upper bound of the distance from the cell's middle to the surface.
    void fill(std::size_t node, std::span<const std::uint32_t> candidates, const Vec3& middle, double size,
              int level, double within) {
        std::vector<std::uint32_t>& listed = listed_[static_cast<std::size_t>(level)];
        listed.clear();
        list_within_reach(candidates, middle, 0.5 * size, listed);
        const double distance = query_point(solid_, middle, within, 0.0, {}).distance;
        octree_.nodes[node].distance = static_cast<float>(distance);
        const bool is_simple = listed.size() <= few_triangles;
        // A cell that lists nothing is not divided if all of it is clear of the surface by a fraction of its
        // size.
        const bool is_clear = std::abs(distance) > 1.25 * half_diagonal * size;
        if (level == levels || (listed.empty() ? is_clear : is_simple)) {
            if (listed.empty()) return;
            OctreeLeaf leaf = leaf_plane(listed);
            if (listed.size() > max_listed) listed.clear();
            leaf.begin = static_cast<std::uint32_t>(octree_.triangles.size());
            octree_.triangles.insert(octree_.triangles.end(), listed.begin(), listed.end());
            leaf.end = static_cast<std::uint32_t>(octree_.triangles.size());
            add_boxes(listed, leaf);
            leaf.convex = is_one_part(listed) && (is_nearly_planar(listed, leaf.spread) || is_convex(listed));
            leaf.front = !listed.empty() && leaf.spread < max_leaf_spread &&
                         is_front_outside(leaf, middle, size, distance);
            octree_.nodes[node].next = -static_cast<std::int32_t>(octree_.leaves.size());
            octree_.leaves.push_back(leaf);
            return;
        }
        const std::size_t first = octree_.nodes.size();
        octree_.nodes[node].next = static_cast<std::int32_t>(first);
        octree_.nodes.resize(first + 8, {0.0F, 0});
        const double quarter = 0.25 * size;
        for (unsigned i = 0; i < 8; ++i) {
            const Vec3 child = middle + quarter * Vec3(i & 1U ? 1 : -1, i & 2U ? 1 : -1, i & 4U ? 1 : -1);
            fill(first + i, listed, child, 0.5 * size, level + 1,
                 std::abs(distance) + glm::length(child - middle) + octree_.rounding);
        }
    }

  private:
    // Appends the triangles that may be within reach of the cell, judged by their boxes and planes.
    void list_within_reach(std::span<const std::uint32_t> candidates, const Vec3& middle, double half,
                           std::vector<std::uint32_t>& listed) const {
        const Float4 at{static_cast<float>(middle.x), static_cast<float>(middle.y),
                        static_cast<float>(middle.z), 0.0F};
        // The comparison in float rejects most triangles. The margin exceeds its error.
        const double margin = 1e-6 * (1.0 + half + glm::length(middle));
        const Float4 reach =
            Float4{} + static_cast<float>(half + listing_distance + octree_rounding + margin);
        for (const std::uint32_t t : candidates) {
            const Float4 below = bounds_[t].low - at;
            const Float4 above = at - bounds_[t].high;
            const auto clear = (below > above ? below : above) > reach;
            if ((clear[0] | clear[1] | clear[2]) == 0 && is_within_reach(bounds_[t], middle, half))
                listed.push_back(t);
        }
    }
    static bool is_within_reach(const TriangleBounds& bounds, const Vec3& middle, double half) {
        constexpr double within = listing_distance + octree_rounding;
        const Vec3 low(bounds.low[0], bounds.low[1], bounds.low[2]);
        const Vec3 high(bounds.high[0], bounds.high[1], bounds.high[2]);
        const Vec3 gap = glm::max(glm::max(low - middle, middle - high) - half, Vec3(0.0));
        if (glm::dot(gap, gap) > within * within) return false;
        const Vec3 normal(bounds.normal);
        const Vec3 size = glm::abs(normal);
        return std::abs(glm::dot(normal, middle - Vec3(bounds.corner))) <=
               half * (size.x + size.y + size.z) + within;
    }

    void add_boxes(std::span<const std::uint32_t> listed, OctreeLeaf& leaf) {
        leaf.boxes = static_cast<std::uint32_t>(octree_.boxes.size());
        for (int side = 0; side < 2; ++side)
            for (int k = 0; k < 3; ++k)
                for (std::size_t i = 0; i < (listed.size() + 3) / 4 * 4; ++i) {
                    constexpr float padding = 1e9F;
                    if (i >= listed.size()) {
                        octree_.boxes.push_back(padding);
                        continue;
                    }
                    const TriangleBounds& bounds = bounds_[listed[i]];
                    octree_.boxes.push_back(side == 0 ? bounds.low[k] : bounds.high[k]);
                }
    }

    // Returns true if the part of the cell in front of the leaf's plane is outside the solid. No surface
    // intersects that part, so one of its points decides for all.
    [[nodiscard]] bool is_front_outside(const OctreeLeaf& leaf, const Vec3& middle, double size,
                                        double distance) const {
        if (glm::dot(leaf.normal, middle) > leaf.height) return distance > 0.0;
        const Vec3 towards_front = glm::mix(Vec3(-1.0), Vec3(1.0), glm::greaterThan(leaf.normal, Vec3(0.0)));
        const Vec3 corner = middle + 0.5 * size * towards_front;
        if (!(glm::dot(leaf.normal, corner) > leaf.height)) return false;
        return query_point(solid_, corner, infinite_distance, 0.0, {}).distance > 0.0;
    }

    [[nodiscard]] OctreeLeaf leaf_plane(std::span<const std::uint32_t> listed) const {
        OctreeLeaf leaf;
        leaf.spread = static_cast<float>(pi);
        Vec3 sum(0.0);
        for (const std::uint32_t t : listed) sum += Vec3(solid_.mesh.face_normals[t]);
        if (!(glm::length(sum) > 1e-3)) return leaf;
        leaf.normal = glm::normalize(sum);
        double least = 1.0;
        leaf.height = -infinite_distance;
        for (const std::uint32_t t : listed) {
            least = std::min(least, glm::dot(leaf.normal, Vec3(solid_.mesh.face_normals[t])));
            for (const glm::vec3& v : solid_.corners[t])
                leaf.height = std::max(leaf.height, glm::dot(leaf.normal, Vec3(v)));
        }
        leaf.height += 1e-9;
        leaf.spread = static_cast<float>(std::acos(std::clamp(least, -1.0, 1.0)) + 1e-4);
        return leaf;
    }

    [[nodiscard]] bool is_one_part(std::span<const std::uint32_t> listed) const {
        return std::all_of(listed.begin(), listed.end(),
                           [&](std::uint32_t t) { return solid_.part[t] == solid_.part[listed[0]]; });
    }

    // Returns true if the triangles form one nearly planar sheet: within reach of any point none of them
    // rises high enough above another to get a separating plane of its own. Two separate sheets of a closed
    // surface are impossible, because the triangles that connect them would be listed too.
    [[nodiscard]] bool is_nearly_planar(std::span<const std::uint32_t> listed, float spread) const {
        // rad, largest angle between two triangles.
        constexpr double max_angle = 0.9 * plane_tolerance / (2.0 * listing_distance);
        if (solid_.mesh.open_edges > 0 || static_cast<double>(spread) > max_angle) return false;
        const double least = 1.0 - 0.5 * max_angle * max_angle;
        for (const std::uint32_t a : listed)
            for (const std::uint32_t b : listed)
                if (glm::dot(Vec3(solid_.mesh.face_normals[a]), Vec3(solid_.mesh.face_normals[b])) < least)
                    return false;
        return true;
    }

    [[nodiscard]] bool is_convex(std::span<const std::uint32_t> listed) const {
        if (listed.size() > max_convexity_test) return false;
        for (const std::uint32_t t : listed) {
            const Vec3 normal(solid_.mesh.face_normals[t]);
            const double height = glm::dot(normal, Vec3(solid_.corners[t][0])) + convexity_tolerance;
            for (const std::uint32_t other : listed)
                for (const glm::vec3& v : solid_.corners[other])
                    if (glm::dot(normal, Vec3(v)) > height) return false;
        }
        return true;
    }

    const Solid& solid_;
    std::span<const TriangleBounds> bounds_;
    TriangleOctree& octree_;
    std::array<std::vector<std::uint32_t>, levels + 1> listed_;  // of the cell being filled at each level
};

// By root cell: the triangles that may be within reach of it.
std::vector<std::vector<std::uint32_t>> triangles_by_root_cell(const Solid& solid,
                                                               const TriangleOctree& octree) {
    const auto [nx, ny, nz] = octree.root_counts;
    std::vector<std::vector<std::uint32_t>> triangles(static_cast<std::size_t>(nx * ny * nz));
    for (std::uint32_t t = 0; t < solid.corners.size(); ++t) {
        const auto& c = solid.corners[t];
        const Vec3 low(glm::min(glm::min(c[0], c[1]), c[2]));
        const Vec3 high(glm::max(glm::max(c[0], c[1]), c[2]));
        const glm::ivec3 from((low - listing_distance - octree_rounding - octree.low) / octree.root_size);
        const glm::ivec3 to((high + listing_distance + octree_rounding - octree.low) / octree.root_size);
        for (int z = std::max(0, from.z); z <= std::min(nz - 1, to.z); ++z)
            for (int y = std::max(0, from.y); y <= std::min(ny - 1, to.y); ++y)
                for (int x = std::max(0, from.x); x <= std::min(nx - 1, to.x); ++x)
                    triangles[static_cast<std::size_t>((z * ny + y) * nx + x)].push_back(t);
    }
    return triangles;
}

// Replaces root cell `root` of the octree by the only root cell of `cell`.
void append(TriangleOctree& octree, std::size_t root, const TriangleOctree& cell) {
    // Neither the root node nor the leaf that is not used is appended.
    const auto first_node = static_cast<std::int32_t>(octree.nodes.size()) - 1;
    const auto first_leaf = static_cast<std::int32_t>(octree.leaves.size()) - 1;
    const auto moved = [&](OctreeNode node) {
        if (node.next != 0) node.next += node.next > 0 ? first_node : -first_leaf;
        return node;
    };
    octree.nodes[root] = moved(cell.nodes[0]);
    std::transform(cell.nodes.begin() + 1, cell.nodes.end(), std::back_inserter(octree.nodes), moved);
    const auto first_triangle = static_cast<std::uint32_t>(octree.triangles.size());
    const auto first_box = static_cast<std::uint32_t>(octree.boxes.size());
    std::transform(cell.leaves.begin() + 1, cell.leaves.end(), std::back_inserter(octree.leaves),
                   [&](OctreeLeaf leaf) {
                       leaf.begin += first_triangle, leaf.end += first_triangle, leaf.boxes += first_box;
                       return leaf;
                   });
    octree.triangles.insert(octree.triangles.end(), cell.triangles.begin(), cell.triangles.end());
    octree.boxes.insert(octree.boxes.end(), cell.boxes.begin(), cell.boxes.end());
}

// Joins octrees of one root cell each, in the order of `TriangleOctree::nodes`, and empties them.
void append_all(TriangleOctree& octree, std::span<TriangleOctree> cells) {
    const auto total = [&](auto member) {
        std::size_t sum = 0;
        for (const TriangleOctree& cell : cells) sum += (cell.*member).size();
        return sum;
    };
    octree.nodes.reserve(total(&TriangleOctree::nodes));
    octree.leaves.reserve(total(&TriangleOctree::leaves));
    octree.triangles.reserve(total(&TriangleOctree::triangles));
    octree.boxes.reserve(total(&TriangleOctree::boxes));
    octree.nodes.resize(cells.size(), {0.0F, 0});
    octree.leaves.emplace_back();
    for (std::size_t root = 0; root < cells.size(); ++root)
        append(octree, root, std::exchange(cells[root], {}));
}

}  // namespace

TriangleOctree make_triangle_octree(const Solid& solid, double cell) {
    TriangleOctree octree;
    if (!(cell > 0.0)) return octree;
    octree.root_size = cell * (1 << levels);
    octree.inverse_root_size = 1.0 / octree.root_size;
    for (std::size_t i = 0; i < octree.sizes.size(); ++i)
        octree.sizes[i] = std::ldexp(octree.root_size, -static_cast<int>(i));
    octree.low = solid.box.low - octree.root_size;
    const Vec3 size = (solid.box.high - solid.box.low) / octree.root_size;
    octree.rounding = 1e-6 * (1.0 + glm::length(solid.box.high - solid.box.low) + 8.0 * octree.root_size);
    for (int k = 0; k < 3; ++k)
        octree.root_counts[static_cast<std::size_t>(k)] = static_cast<int>(std::ceil(size[k])) + 2;
    const int nx = octree.root_counts[0], ny = octree.root_counts[1];
    const std::vector<TriangleBounds> bounds = triangle_bounds(solid);
    const std::vector<std::vector<std::uint32_t>> candidates = triangles_by_root_cell(solid, octree);
    std::vector<TriangleOctree> cells(candidates.size());
    for_each_in_parallel(cells.size(), [&](std::size_t i) {
        const auto index = static_cast<int>(i);
        const Vec3 at(index % nx, index / nx % ny, index / nx / ny);
        cells[i].rounding = octree.rounding;
        cells[i].nodes.resize(1, {0.0F, 0});
        cells[i].leaves.emplace_back();
        CellBuilder(solid, bounds, cells[i])
            .fill(0, candidates[i], octree.low + octree.root_size * (at + 0.5), octree.root_size, 0,
                  infinite_distance);
    });
    append_all(octree, cells);
    return octree;
}

namespace {

// Descends to the leaf that contains a point; the node is null outside the octree.
OctreeCursor find_leaf(const TriangleOctree& octree, const Vec3& from_low) {
    const Vec3 at = from_low * octree.inverse_root_size;
    for (int k = 0; k < 3; ++k)
        if (!(at[k] >= 0.0 && at[k] < static_cast<double>(octree.root_counts[static_cast<std::size_t>(k)])))
            return {};
    const glm::ivec3 cell(at);
    const OctreeNode* node = &octree.nodes[static_cast<std::size_t>(
        (cell.z * octree.root_counts[1] + cell.y) * octree.root_counts[0] + cell.x)];
    // Index of the smallest cell within the root cell; its bits, from the highest, select the child at each
    // level.
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
    return {octree.root_size * Vec3(cell) + size * (whole + 0.5), 0.5 * size, node};
}

}  // namespace

OctreeQuery query(const TriangleOctree& octree, const Vec3& point) {
    OctreeCursor unused;
    return query(octree, point, unused);
}

OctreeQuery query(const TriangleOctree& octree, const Vec3& point, OctreeCursor& last) {
    if (octree.nodes.empty()) return {};
    const Vec3 from_low = point - octree.low;
    Vec3 offset = from_low - last.middle;
    const auto is_inside = [&] {
        return std::abs(offset.x) < last.half && std::abs(offset.y) < last.half &&
               std::abs(offset.z) < last.half;
    };
    if (!is_inside()) {
        last = find_leaf(octree, from_low);
        if (last.node == nullptr) return {};
        offset = from_low - last.middle;
    }
    const OctreeNode* node = last.node;
    const double half = last.half;
    const double displacement = glm::length(offset) + octree.rounding;
    const auto distance = static_cast<double>(node->distance);
    OctreeQuery result{distance - displacement, std::abs(distance) + displacement, nullptr, 0.0};
    const Vec3 inward = half - glm::abs(offset);
    const double unlisted_distance =
        std::min({inward.x, inward.y, inward.z}) + listing_distance - octree.rounding;
    result.unlisted_distance = unlisted_distance;
    if (node->next == 0) {
        if (distance > 0.0) result.lower = std::max(result.lower, unlisted_distance);
        return result;
    }
    result.leaf = &octree.leaves[static_cast<std::size_t>(-node->next)];
    if (result.leaf->begin == result.leaf->end) {
        result.leaf = nullptr;
        return result;
    }
    const double above = glm::dot(result.leaf->normal, point) - result.leaf->height;
    if (result.leaf->front && above > 0.0)
        result.lower = std::max(result.lower, std::min(above, unlisted_distance));
    return result;
}

}  // namespace bolt::collision
