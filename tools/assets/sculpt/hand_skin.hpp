// Which joints carry a point of the hand's skin, and how much.
#pragma once

#include <array>
#include <cstdint>

#include "tools/assets/sculpt/hand_shape.hpp"

namespace bolt::sculpt {

// At most four joints; weights are multiples of 1/256 and sum to one exactly. Joints without weight are 0.
struct Influences {
    std::array<std::uint16_t, 4> joints{};
    std::array<float, 4> weights{};
};

// Smooth over the hand, and bounded: past the web a finger answers to its own joints alone.
Influences influences(const HandShape& shape, const Vec3& p);

}  // namespace bolt::sculpt
