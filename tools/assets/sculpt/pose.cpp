#include "tools/assets/sculpt/pose.hpp"

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <string>

namespace bolt::sculpt {
namespace {

struct FingerFlexion {
    double proximal, intermediate, distal, sideways;
};

void bend(HandPosture& pose, std::size_t digit, const FingerFlexion& flexion) {
    const std::size_t first = digits[digit].first;
    pose.set(first + 1, flexion.proximal, flexion.sideways, 0.0);
    pose.flex(first + 2, flexion.intermediate);
    pose.flex(first + 3, flexion.distal);
}

HandPosture fist() {
    HandPosture pose;
    bend(pose, 1, {72, 86, 48, -9});
    bend(pose, 2, {74, 88, 50, -1});
    bend(pose, 3, {74, 87, 50, 7});
    bend(pose, 4, {74, 82, 50, 15});
    pose.set(thumb_metacarpal, 26, 0, 38);
    pose.flex(thumb_proximal, 15);
    pose.flex(thumb_distal, 27);
    return pose;
}

HandPosture pinch() {
    HandPosture pose;
    bend(pose, 1, {44, 43, 22, -7});
    bend(pose, 2, {22, 26, 12, 0});
    bend(pose, 3, {16, 22, 10, 0});
    bend(pose, 4, {12, 18, 8, 0});
    pose.set(thumb_metacarpal, 29, -11, 38);
    pose.flex(thumb_proximal, -2);
    pose.flex(thumb_distal, -4);
    return pose;
}

// Around the handle of a wrench of about 25 mm by 10 mm.
HandPosture grip() {
    HandPosture pose;
    bend(pose, 1, {62, 76, 40, -8});
    bend(pose, 2, {65, 80, 42, -1});
    bend(pose, 3, {66, 80, 42, 6});
    bend(pose, 4, {66, 76, 42, 14});
    pose.set(thumb_metacarpal, 16, 12, 38);
    pose.flex(thumb_proximal, 40);
    pose.flex(thumb_distal, 16);
    return pose;
}

HandPosture open() {
    HandPosture pose;
    for (std::size_t d = 1; d < 5; ++d) bend(pose, d, {-8, -13, -8, 0});
    return pose;
}

struct JointTransforms {
    std::array<glm::dmat4, joint_count> global{};
};

Result<JointTransforms> pose_joints(const assets::Model& hand, const HandPosture& pose) {
    const auto invalid_hand = [](const std::string& what) {
        return fail(ErrorCode::bad_content, what, "a hand with the joints of XR_EXT_hand_tracking");
    };
    JointTransforms joints;
    std::array<std::size_t, joint_count> nodes{};
    for (std::size_t i = 0; i < joint_count; ++i) {
        const auto node = std::find_if(hand.nodes.begin(), hand.nodes.end(),
                                       [&](const assets::Node& n) { return n.name == joint_names[i]; });
        if (node == hand.nodes.end())
            return invalid_hand("has no joint '" + std::string(joint_names[i]) + "'");
        nodes[i] = static_cast<std::size_t>(node - hand.nodes.begin());
    }
    std::array<bool, joint_count> known{};
    const std::function<void(std::size_t)> compute_global = [&](std::size_t i) {
        if (known[i]) return;
        const assets::Node& node = hand.nodes[nodes[i]];
        glm::dmat4 local = glm::mat4_cast(Quat(node.rotation) * pose.turn[i]);
        local[3] = glm::dvec4(Vec3(node.translation), 1.0);
        if (parent_of(i) == joint_count) {
            joints.global[i] = local;
        } else {
            compute_global(parent_of(i));
            joints.global[i] = joints.global[parent_of(i)] * local;
        }
        known[i] = true;
    };
    for (std::size_t i = 0; i < joint_count; ++i) compute_global(i);
    return joints;
}

Result<assets::Model> skinned(const assets::Model& hand, const JointTransforms& joints) {
    if (hand.skins.empty() || hand.skins[0].joints.size() != joint_count || hand.meshes.empty()) {
        return fail(ErrorCode::bad_content, "has no skinned mesh", "a hand made by bolt-sculpt");
    }
    std::vector<glm::dmat4> bones;
    for (std::size_t i = 0; i < joint_count; ++i) {
        const auto node = static_cast<std::size_t>(hand.skins[0].joints[i]);
        const auto joint = std::find(joint_names.begin(), joint_names.end(), hand.nodes[node].name);
        if (joint == joint_names.end())
            return fail(ErrorCode::bad_content, "the skin has a joint of another skeleton",
                        "the joints of XR_EXT_hand_tracking");
        bones.push_back(joints.global[static_cast<std::size_t>(joint - joint_names.begin())] *
                        glm::dmat4(hand.skins[0].inverse_bind[i]));
    }
    assets::Model out = hand;
    for (assets::Primitive& primitive : out.meshes[0].primitives) {
        for (std::size_t v = 0; v < primitive.positions.size(); ++v) {
            glm::dmat4 blend(0.0);
            for (int k = 0; k < 4; ++k) {
                blend += static_cast<double>(primitive.weights[v][k]) * bones[primitive.joints[v][k]];
            }
            const glm::dmat3 turn(blend);
            primitive.positions[v] = Vec3(blend * glm::dvec4(Vec3(primitive.positions[v]), 1.0));
            primitive.normals[v] = glm::normalize(turn * Vec3(primitive.normals[v]));
            if (primitive.tangents.empty()) continue;
            const Vec3 tangent = glm::normalize(turn * Vec3(primitive.tangents[v]));
            primitive.tangents[v] = glm::vec4(glm::vec3(tangent), primitive.tangents[v].w);
        }
        primitive.joints.clear();
        primitive.weights.clear();
    }
    assets::Node node;
    node.name = hand.meshes[0].name;
    node.mesh = 0;
    out.nodes = {node};
    out.roots = {0};
    out.skins.clear();
    return out;
}

}  // namespace

void HandPosture::flex(std::size_t joint, double degrees) { set(joint, degrees, 0.0, 0.0); }

void HandPosture::set(std::size_t joint, double flexion, double sideways, double roll) {
    turn[joint] = glm::angleAxis(to_radians(sideways), Vec3(0, 1, 0)) *
                  glm::angleAxis(to_radians(-flexion), Vec3(1, 0, 0)) *
                  glm::angleAxis(to_radians(roll), Vec3(0, 0, 1));
}

std::optional<HandPosture> named_pose(std::string_view name) {
    if (name == "relaxed") return HandPosture();
    if (name == "open") return open();
    if (name == "fist") return fist();
    if (name == "pinch") return pinch();
    if (name == "grip") return grip();
    return std::nullopt;
}

HandPosture mirrored(const HandPosture& pose) {
    HandPosture out;
    for (std::size_t i = 0; i < joint_count; ++i) out.turn[i] = hand::mirrored(pose.turn[i]);
    return out;
}

Result<Skeleton> posed_joints(const assets::Model& hand, const HandPosture& pose) {
    const Result<JointTransforms> joints = pose_joints(hand, pose);
    if (!joints) return tl::unexpected(joints.error());
    Skeleton out;
    for (std::size_t i = 0; i < joint_count; ++i) {
        out.position[i] = Vec3(joints->global[i][3]);
        out.rotation[i] = glm::normalize(glm::quat_cast(glm::dmat3(joints->global[i])));
    }
    return out;
}

Result<assets::Model> posed(const assets::Model& hand, const HandPosture& pose) {
    const Result<JointTransforms> joints = pose_joints(hand, pose);
    if (!joints) return tl::unexpected(joints.error());
    return skinned(hand, *joints);
}

Result<assets::Model> posed(const assets::Model& hand, const Skeleton& joints) {
    JointTransforms at;
    for (std::size_t i = 0; i < joint_count; ++i) {
        at.global[i] = glm::mat4_cast(joints.rotation[i]);
        at.global[i][3] = glm::dvec4(joints.position[i], 1.0);
    }
    return skinned(hand, at);
}

}  // namespace bolt::sculpt
