// Where things and people are before and beside a machine.
#pragma once

#include <algorithm>
#include <optional>

#include "engine/base/pose.hpp"
#include "engine/render/box.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::scene {

// Whoever works: with which hand, and how high.
struct Worker {
    hand::Side side = hand::Side::right;
    std::optional<double> seated_eyes;  // m, of the eyes above the floor; none: standing
};

inline constexpr double floor_below_plate = 0.85;    // m, of the workshop (content/environments)
inline constexpr double shoulders_below_eyes = 0.2;  // m, about what DIN 33402-2 has for those who sit

// Where a wrench lies: before the machine, its handle along x to the side of the hand that takes it, its
// jaw's normal up.
inline Pose resting_place(const render::BoundingBox& machine, double head_thickness,
                          hand::Side side = hand::Side::right) {
    const Vec3 low(machine.low), high(machine.high);
    const Quat round = glm::angleAxis(side == hand::Side::left ? pi : 0.0, Vec3(0, 1, 0));
    return {{0.5 * (low.x + high.x), low.y + 0.5 * head_thickness + 0.002, high.z + 0.06},
            round * glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0))};
}

// m, of the eyes of somebody who sits.
inline std::optional<double> eye_level(const render::BoundingBox& machine, const Worker& worker) {
    if (!worker.seated_eyes) return std::nullopt;
    return static_cast<double>(machine.low.y) - floor_below_plate + *worker.seated_eyes;
}

// The shoulder of the hand that works.
inline Vec3 shoulder_at(const render::BoundingBox& machine, const Worker& worker = {}) {
    const Vec3 low(machine.low), high(machine.high);
    Vec3 at = high + Vec3(0.35, 0.3, 0.4);
    if (worker.side == hand::Side::left) at.x = low.x - 0.35;
    if (const auto eyes = eye_level(machine, worker)) at.y = std::min(at.y, *eyes - shoulders_below_eyes);
    return at;
}

}  // namespace bolt::scene
