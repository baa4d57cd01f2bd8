// Bending a hand: named poses, and the mesh as a skin on its joints (linear blend skinning).
#pragma once

#include <optional>
#include <string_view>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::sculpt {

using namespace hand;  // the joints and their names

// What each joint of the right hand turns from its rest, in its own frame.
struct HandPosture {
    std::array<Quat, joint_count> turn;
    HandPosture() { turn.fill(Quat(1.0, 0.0, 0.0, 0.0)); }
    // Degrees; positive bends towards the palm.
    void flex(std::size_t joint, double degrees);
    // Flexion, then the sideways turn about the joint's up axis (positive: to the left of the bone), then
    // roll about the bone.
    void set(std::size_t joint, double flexion, double sideways, double roll);
};

inline constexpr std::array<std::string_view, 5> pose_names{"open", "relaxed", "fist", "pinch", "grip"};
std::optional<HandPosture> named_pose(std::string_view name);

// The same pose for the left hand.
HandPosture mirrored(const HandPosture& pose);

// A copy of the hand without its skin, in the pose. Joints are found by name.
Result<assets::Model> posed(const assets::Model& hand, const HandPosture& pose);

// The same with its joints where they are put, in the frame of the model.
Result<assets::Model> posed(const assets::Model& hand, const Skeleton& joints);

// Where the joints are in the pose, in the frame of the wrist.
Result<Skeleton> posed_joints(const assets::Model& hand, const HandPosture& pose);

}  // namespace bolt::sculpt
