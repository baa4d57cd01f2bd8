// Where everything in a model is at one moment: poses, the animations that make them, and the matrices that
// bend a skin.
//   glTF 2.0 specification (Khronos, 2021), sections 3.7.3 (skins), 3.11 (animations) and appendix C
//   (interpolation).
#pragma once

#include <span>
#include <vector>

#include "engine/assets/model.hpp"

namespace bolt::assets {

struct NodePose {
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    std::vector<float> weights = {};  // of its mesh's morph targets
};

// Beside model.nodes.
using Pose = std::vector<NodePose>;

// What the nodes say of themselves; weights that a node does not give are those of its mesh.
Pose rest_pose(const Model& model);

// Moves what the animation moves to where it is at that time: as at its first and last key before and after
// them.
void apply(const Animation& animation, float seconds, Pose& pose);

// When its last key is, s.
float duration(const Animation& animation);

// One channel's value: 3, 4 (a unit quaternion, x y z w) or as many numbers as there are weights.
std::vector<float> sample(const Channel& channel, float seconds);

// Of every node, from the scene's origin.
std::vector<glm::mat4> world_transforms(const Model& model, const Pose& pose);

// What takes a vertex as it was bound to where the joints are, for each joint of the skin.
std::vector<glm::mat4> joint_matrices(const Skin& skin, std::span<const glm::mat4> world);

// The model with this pose as its rest.
void set_rest(Model& model, const Pose& pose);

}  // namespace bolt::assets
