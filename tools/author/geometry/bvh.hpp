// A box along the axes, and a triangle that knows which part it belongs to.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <optional>
#include <vector>

#include "engine/base/math.hpp"

namespace bolt::geometry {

struct Box {
    Vec3 low{std::numeric_limits<double>::infinity()};
    Vec3 high{-std::numeric_limits<double>::infinity()};

    void add(const Vec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
    [[nodiscard]] Vec3 middle() const { return 0.5 * (low + high); }
    [[nodiscard]] Vec3 half() const { return 0.5 * (high - low); }
};

struct Triangle {
    Vec3 a, b, c;
    std::uint32_t part = 0;
};

inline Vec3 normal_of(const Triangle& t) { return glm::cross(t.b - t.a, t.c - t.a); }  // twice the area

// Triangles in a tree of boxes, in double precision: rays through them, and what of one set crosses another.

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

// Whether one set of triangles, turned and shifted, crosses another. Surfaces that only touch do not cross.

// A turn about +Y, then a shift.
struct TurnAboutY {
    double cosine = 1.0, sine = 0.0;
    Vec3 shift{0.0};

    static TurnAboutY turned(double angle, const Vec3& shift) {
        return {std::cos(angle), std::sin(angle), shift};
    }
    [[nodiscard]] Vec3 operator()(const Vec3& p) const {
        return Vec3{p.x * cosine + p.z * sine, p.y, p.z * cosine - p.x * sine} + shift;
    }
};

// An edge of one triangle passes through the other.
bool cross(const Triangle& s, const Triangle& t);

// A triangle of `still` that one of `moving`, in its pose, crosses.
std::optional<std::uint32_t> first_crossing(const Bvh& still, const Bvh& moving, const TurnAboutY& pose,
                                            const Skip& skip = {});

}  // namespace bolt::geometry
