// A gloved hand as a glTF model: one skinned mesh of four materials on the 26 joints of XR_EXT_hand_tracking.
//
// Nodes: `hand_right` or `hand_left` (the mesh) and the joint `wrist` with all others below it, named as
// XrHandJointEXT in lower case: wrist, palm, thumb_metacarpal … little_tip. The frame of the file is that of
// the wrist joint: −Z to the finger tips, +Y out of the back of the hand. Joint i of the skin is
// XrHandJointEXT i.
#pragma once

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "tools/assets/sculpt/hand_shape.hpp"

namespace bolt::sculpt {

// Triangles at most; meshoptimizer chooses where.
inline constexpr std::size_t hand_triangles = 12000;

// The left hand is the right one mirrored in x = 0, number by number.
struct Hands {
    assets::Model left, right;
};
Result<Hands> make_hands();

}  // namespace bolt::sculpt
