// A gloved hand as a glTF model: one skinned mesh of four materials on the 26 joints of XR_EXT_hand_tracking.
//
// Nodes: `hand_right` or `hand_left` (the mesh) and the joint `wrist` with all others below it, named as
// XrHandJointEXT in lower case: wrist, palm, thumb_metacarpal … little_tip. The frame of the file is that of
// the wrist joint: −Z towards the finger tips, +Y out of the back of the hand. Joint i of the skin is
// XrHandJointEXT i.
#pragma once

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "tools/assets/sculpt/hand_shape.hpp"

namespace bolt::sculpt {

// Maximum number of triangles of a hand.
inline constexpr std::size_t hand_triangles = 12000;

// The left hand is the right hand mirrored in x = 0, exactly.
struct HandModels {
    assets::Model left, right;
};
Result<HandModels> make_hands();

}  // namespace bolt::sculpt
