// Puts the fasteners of each joint under one node of the tree.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/author/import/joints.hpp"

namespace bolt::step_import {

namespace {

// The shortest rotation that takes +Y to the axis.
Quat rotation_to(const Vec3& axis) {
    const Vec3 up{0.0, 1.0, 0.0};
    const double cos = glm::dot(up, axis);
    if (cos > 1.0 - 1e-12) return {1.0, 0.0, 0.0, 0.0};
    if (cos < -1.0 + 1e-12) return {0.0, 1.0, 0.0, 0.0};
    const Vec3 cross = glm::cross(up, axis);
    return glm::normalize(Quat{1.0 + cos, cross.x, cross.y, cross.z});
}

// Adds a node at the seat, under the nearest common ancestor of bolt and nut, or beside a screw.
int make_group(Tree& tree, const JointCandidate& joint) {
    const int node = static_cast<int>(tree.nodes.size());
    TreeNode group;
    group.local = {rotation_to(joint.axis), joint.seat, 1.0};
    tree.nodes.push_back(group);
    tree.roots.push_back(node);
    if (const int parent = common_parent(tree, joint.bolt, joint.is_screw() ? joint.bolt : joint.nut);
        parent >= 0)
        move_under(tree, node, parent);
    return node;
}

// Adds a remark if the pose of the group in the file differs from that of the joint.
void check_group(const Tree& tree, const JointCandidate& joint, std::vector<std::string>& remarks) {
    const ScaledPose pose = world(tree, joint.group);
    const double off = glm::length(pose.position - joint.seat) / mm;
    const double turn = glm::dot(pose.direction({0.0, 1.0, 0.0}), joint.axis);
    const std::string& name = tree.nodes[static_cast<std::size_t>(joint.group)].name;
    if (off > 0.01)
        remarks.push_back(
            fmt::format("{}: its origin is {:.3f} mm from the centre of the hole on its seat", name, off));
    if (turn < 1.0 - 1e-6)
        remarks.push_back(fmt::format("{}: its +Z axis is {:.2f} degrees off the bolt's", name,
                                      to_degrees(std::acos(std::clamp(turn, -1.0, 1.0)))));
}

}  // namespace

void add_joint_nodes(Tree& tree, JointSearchResult& search) {
    for (JointCandidate& joint : search.joints) {
        if (joint.group >= 0)
            check_group(tree, joint, search.remarks);
        else
            joint.group = make_group(tree, joint);
        const auto add_child = [&](int node, const std::string& name) {
            if (tree.nodes[static_cast<std::size_t>(node)].parent != joint.group)
                move_under(tree, node, joint.group);
            tree.nodes[static_cast<std::size_t>(node)].name = joint.id + "_" + name;
            tree.nodes[static_cast<std::size_t>(node)].fixed = true;
        };
        tree.nodes[static_cast<std::size_t>(joint.group)].name = std::string(joint_prefix) + joint.id;
        tree.nodes[static_cast<std::size_t>(joint.group)].fixed = true;
        add_child(joint.bolt, "bolt");
        for (const int washer : joint.head_washers) add_child(washer, "washer_head");
        for (const int washer : joint.nut_washers) add_child(washer, "washer_nut");
        if (!joint.is_screw()) add_child(joint.nut, "nut");
    }
}

}  // namespace bolt::step_import
