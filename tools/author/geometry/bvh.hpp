// Triangles in a tree of boxes, in double precision: rays through them, and what of one set crosses another.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/author/geometry/box.hpp"

namespace bolt::geometry {

class Bvh {
  public:
    struct Node {
        Vec3 middle, half;
        std::uint32_t first = 0;  // triangle of a leaf, left child otherwise (the right one follows it)
        std::uint32_t count = 0;  // triangles of a leaf; 0: not a leaf
    };

    Bvh() = default;
    explicit Bvh(std::vector<Triangle> triangles);

    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }  // root first; empty: none
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] Box box() const;

  private:
    void split(std::uint32_t node, std::uint32_t first, std::uint32_t count);
    std::vector<Node> nodes_;
    std::vector<Triangle> triangles_;
};

// Parts that are looked through.
using Skip = std::function<bool(std::uint32_t part)>;

struct RayHit {
    double distance = 0.0;
    std::uint32_t triangle = 0;
};

// The nearest hit within `reach`, from either side. `direction`: unit.
std::optional<RayHit> first_hit(const Bvh& bvh, const Vec3& origin, const Vec3& direction, double reach,
                                const Skip& skip = {});

}  // namespace bolt::geometry
