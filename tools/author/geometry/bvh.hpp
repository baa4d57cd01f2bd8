// A tree of axis-aligned boxes over triangles, in double precision: ray queries, and tests for crossings of
// two triangle sets, one of which may move. Metres in every interface.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
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

// Rotation, then translation.
struct RigidMotion {
    glm::dmat3 turn{1.0};
    Vec3 shift{0.0};

    // `angle`: rad about +Y.
    static RigidMotion about_y(double angle, const Vec3& shift) {
        const double c = std::cos(angle), s = std::sin(angle);
        return {glm::dmat3(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c), shift};
    }
    [[nodiscard]] Vec3 operator()(const Vec3& p) const { return turn * p + shift; }
};

// The motions in the neighbourhood of a given motion: the moving triangles are first rotated about their own
// +Y by at most `turn` rad to either side, then moved by the given motion, and at last shifted along `slide`
// (m), forwards or backwards, by at most its length.
struct Sweep {
    double turn = 0.0;
    Vec3 slide{0.0};
};

// Returns true if an edge of one triangle passes through the other. Triangles that only touch do not cross.
bool triangles_cross(const Triangle& s, const Triangle& t);

// Returns the index of a triangle of `still` that crosses a triangle of `moving` placed by `pose`; nullopt if
// there is none.
std::optional<std::uint32_t> first_crossing(const Bvh& still, const Bvh& moving, const RigidMotion& pose,
                                            const SkipPart& skip = {});

// Returns false only if no triangles cross in any motion of the sweep about `pose`. Compares boxes.
bool may_cross(const Bvh& still, const Bvh& moving, const RigidMotion& pose, const Sweep& sweep);

// Returns false only if no triangles cross when `moving` stands `height` m above the origin of a frame and is
// turned about the frame's +Y by any angle. `to_still`: from that frame to that of `still`. Compares the
// distances from the axis.
bool may_cross_at_any_angle(const Bvh& still, const Bvh& moving, const RigidMotion& to_still, double height);

}  // namespace bolt::geometry
