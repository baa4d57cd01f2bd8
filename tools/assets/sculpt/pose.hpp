// Poses of a hand model: named poses, and linear blend skinning of its mesh.
#pragma once

#include <optional>
#include <string_view>

#include "engine/assets/model.hpp"
#include "engine/base/result.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::sculpt {

using namespace hand;  // the joints and their names

// The rotation of each joint of the right hand from rest, in the joint's own frame.
struct HandPosture {
    std::array<Quat, joint_count> turn;
    HandPosture() { turn.fill(Quat(1.0, 0.0, 0.0, 0.0)); }
    // In degrees; positive bends towards the palm.
    void flex(std::size_t joint, double degrees);
    // In degrees: flexion, then the sideways rotation about the joint's up axis (positive: to the left of the
    // bone), then roll about the bone.
    void set(std::size_t joint, double flexion, double sideways, double roll);
};

inline constexpr std::array<std::string_view, 5> pose_names{"open", "relaxed", "fist", "pinch", "grip"};
std::optional<HandPosture> named_pose(std::string_view name);

// Returns the same pose for the left hand.
HandPosture mirrored(const HandPosture& pose);

// Returns a copy of the hand in the pose, as a mesh without a glTF skin. Joints are found by name.
Result<assets::Model> posed(const assets::Model& hand, const HandPosture& pose);

// The same for given global joint transforms in the frame of the model.
Result<assets::Model> posed(const assets::Model& hand, const Skeleton& joints);

// Returns the joints in the pose, in the frame of the wrist.
Result<Skeleton> posed_joints(const assets::Model& hand, const HandPosture& pose);

}  // namespace bolt::sculpt
