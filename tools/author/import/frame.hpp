// From the CAD frame (millimetres, Z up) to the scene's (metres, Y up): x = X, y = Z, z = −Y. Geometry and
// every placement are converted, so that no node has to turn the model.
#pragma once

#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>
#include <gp_XYZ.hxx>

#include "engine/base/math.hpp"

namespace bolt::step_import {

inline constexpr double mm = 1e-3;

inline Vec3 direction_to_scene(const gp_XYZ& v) { return {v.X(), v.Z(), -v.Y()}; }
inline Vec3 point_to_scene(const gp_XYZ& p) { return direction_to_scene(p) * mm; }

inline gp_XYZ point_to_cad(const Vec3& p) { return {p.x / mm, -p.z / mm, p.y / mm}; }

// For messages to the author, who knows the CAD frame.
inline Vec3 point_to_cad_mm(const Vec3& p) { return Vec3{p.x, -p.z, p.y} / mm; }

// A placement: scale, then turn, then move. A negative scale mirrors.
struct Pose {
    Quat rotation{1.0, 0.0, 0.0, 0.0};
    Vec3 position{0.0};
    double scale = 1.0;

    [[nodiscard]] Vec3 point(const Vec3& p) const { return rotation * (p * scale) + position; }
    [[nodiscard]] Vec3 direction(const Vec3& d) const { return rotation * (scale < 0.0 ? -d : d); }
};

inline Pose operator*(const Pose& outer, const Pose& inner) {
    return {outer.rotation * inner.rotation, outer.point(inner.position), outer.scale * inner.scale};
}

inline Pose inverse(const Pose& pose) {
    const Quat turned = glm::conjugate(pose.rotation);
    return {turned, turned * (-pose.position / pose.scale), 1.0 / pose.scale};
}

// Rounding noise (1e-12) is taken off, so that what is not turned has no turn.
inline Pose to_scene(const gp_Trsf& placement) {
    const auto snap = [](double x) { return std::abs(x) < 1e-12 ? 0.0 : x; };
    const gp_Quaternion q = placement.GetRotation();
    Pose pose;
    pose.rotation = {snap(q.W()), snap(q.X()), snap(q.Z()), snap(-q.Y())};
    if (std::abs(std::abs(pose.rotation.w) - 1.0) < 1e-15) pose.rotation = {1.0, 0.0, 0.0, 0.0};
    const Vec3 moved = point_to_scene(placement.TranslationPart());
    pose.position = {snap(moved.x), snap(moved.y), snap(moved.z)};
    pose.scale = placement.ScaleFactor();
    return pose;
}

}  // namespace bolt::step_import
