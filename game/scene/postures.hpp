// How a hand is bent about what it holds, when nobody wears a glove: around the wrench's handle, with thumb
// and index finger on a nut, or open.
#pragma once

#include <optional>

#include "haptics/grip/closing.hpp"

namespace bolt::scene {

// The 26 joints in the frame of the tool (servo::DeviceSample).
struct Postures {
    hand::Skeleton on_handle, on_nut, open;
};

// `grip_at`: m from the jaw's middle along the handle. The fingers close on the wrench as far as it lets
// them.
Postures make_postures(const contact::ToolShape* wrench, double grip_at, hand::Side side = hand::Side::right);

// Between two of them.
hand::Skeleton between(const hand::Skeleton& a, const hand::Skeleton& b, double share);

}  // namespace bolt::scene
