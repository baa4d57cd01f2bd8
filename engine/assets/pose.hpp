// Poses of a model's nodes, the evaluation of animations, and joint matrices of skins. Source: glTF 2.0
// specification (Khronos, 2021), sections 3.7.3 (skins), 3.11 (animations) and appendix C (interpolation).
#pragma once

#include <span>
#include <vector>

#include "engine/assets/model.hpp"

namespace bolt::assets {

struct NodePose {
    glm::vec3 translation{0.0F};
    glm::quat rotation{1.0F, 0.0F, 0.0F, 0.0F};
    glm::vec3 scale{1.0F};
    std::vector<float> weights = {};  // morph target weights of its mesh
};

// One entry per node, in the order of model.nodes.
using ModelPose = std::vector<NodePose>;

// Returns the transforms that the nodes have without animation. A node without weights gets those of its
// mesh.
ModelPose rest_pose(const Model& model);

// Sets the animated values in `pose` for a time in seconds. Before the first and after the last key, the
// value of that key is used.
void apply(const Animation& animation, float seconds, ModelPose& pose);

// Returns the time of the last key, in s.
float duration(const Animation& animation);

// Evaluates one channel. Returns 3 values, 4 (a unit quaternion, x y z w) or one per morph target.
std::vector<float> sample(const AnimationChannel& channel, float seconds);

// Returns the world transform of every node.
std::vector<glm::mat4> world_transforms(const Model& model, const ModelPose& pose);

// Returns, for each joint of the skin, the transform from the bind pose to the joint's current pose. `world`:
// the world transforms of all nodes.
std::vector<glm::mat4> joint_matrices(const Skin& skin, std::span<const glm::mat4> world);

// Makes this pose the model's rest pose.
void set_rest(Model& model, const ModelPose& pose);

}  // namespace bolt::assets
