// Whether one set of triangles, turned and shifted, crosses another. Surfaces that only touch do not cross.
#pragma once

#include <optional>

#include "tools/author/geometry/bvh.hpp"

namespace bolt::geometry {

// A turn about +Y, then a shift.
struct Pose {
    double cosine = 1.0, sine = 0.0;
    Vec3 shift{0.0};

    static Pose turned(double angle, const Vec3& shift) { return {std::cos(angle), std::sin(angle), shift}; }
    [[nodiscard]] Vec3 operator()(const Vec3& p) const {
        return Vec3{p.x * cosine + p.z * sine, p.y, p.z * cosine - p.x * sine} + shift;
    }
};

// An edge of one triangle passes through the other.
bool cross(const Triangle& s, const Triangle& t);

// A triangle of `still` that one of `moving`, in its pose, crosses.
std::optional<std::uint32_t> first_crossing(const Bvh& still, const Bvh& moving, const Pose& pose,
                                            const Skip& skip = {});

}  // namespace bolt::geometry
