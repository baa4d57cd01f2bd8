// A tree of axis-aligned boxes over triangles, in double precision: ray queries, and a test for crossings of
// two triangle sets. Metres in every interface.
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

// Axis-aligned bounding box; empty until the first add().
struct Aabb {
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
    std::uint32_t part = 0;  // index of the part that the triangle belongs to
};

// Normal by the winding; its length is twice the area.
inline Vec3 normal_of(const Triangle& t) { return glm::cross(t.b - t.a, t.c - t.a); }

class Bvh {
  public:
    struct Node {
        Vec3 middle, half;
        std::uint32_t first = 0;  // leaf: first triangle; inner node: left child (the right one is first + 1)
        std::uint32_t count = 0;  // leaf: number of triangles; inner node: 0
    };

    Bvh() = default;
    explicit Bvh(std::vector<Triangle> triangles);

    // The root comes first; empty without triangles.
    [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
    [[nodiscard]] const std::vector<Triangle>& triangles() const { return triangles_; }
    [[nodiscard]] Aabb box() const;

  private:
    void split(std::uint32_t node, std::uint32_t first, std::uint32_t count);
    std::vector<Node> nodes_;
    std::vector<Triangle> triangles_;
};

// Returns true for the parts that a query ignores.
using SkipPart = std::function<bool(std::uint32_t part)>;

struct RayHit {
    double distance = 0.0;
    std::uint32_t triangle = 0;
};

// Returns the nearest hit on either side of a triangle within `reach`, m. `direction` is a unit vector.
std::optional<RayHit> first_hit(const Bvh& bvh, const Vec3& origin, const Vec3& direction, double reach,
                                const SkipPart& skip = {});

// Rotation about +Y, then translation.
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

// Returns true if an edge of one triangle passes through the other. Triangles that only touch do not cross.
bool triangles_cross(const Triangle& s, const Triangle& t);

// Returns the index of a triangle of `still` that crosses a triangle of `moving` placed by `pose`; nullopt if
// there is none.
std::optional<std::uint32_t> first_crossing(const Bvh& still, const Bvh& moving, const TurnAboutY& pose,
                                            const SkipPart& skip = {});

}  // namespace bolt::geometry
