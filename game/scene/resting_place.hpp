// Where things and people are before and beside a machine.
#pragma once

#include "engine/base/pose.hpp"
#include "engine/render/box.hpp"

namespace bolt::scene {

// Where a wrench lies: before the machine, its handle along x, its jaw's normal up.
inline Pose resting_place(const render::Box& machine, double head_thickness) {
    const Vec3 low(machine.low), high(machine.high);
    return {{0.5 * (low.x + high.x), low.y + 0.5 * head_thickness + 0.002, high.z + 0.06},
            glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0))};
}

// The right shoulder of whoever works at it.
inline Vec3 shoulder_at(const render::Box& machine) { return Vec3(machine.high) + Vec3(0.35, 0.3, 0.4); }

}  // namespace bolt::scene
