// Joints that the geometry shows: a hexagon bolt with a nut on its axis, the washers and parts between them.
#pragma once

#include <string>
#include <vector>

#include "tools/author/import/members.hpp"
#include "tools/author/import/tree.hpp"

namespace bolt::step_import {

struct JointCandidate {
    std::string id;
    std::string size;          // "M16", "M16x1.5"
    double bolt_length = 0.0;  // m, under the head
    double grip = 0.0;         // m, of the members
    Vec3 seat{0.0};            // centre of the hole on the face of the member under the nut
    Vec3 axis{0.0, 1.0, 0.0};  // from the members to the nut
    int bolt = -1, nut = -1;   // nodes
    std::vector<int> head_washers, nut_washers;
    std::vector<ClampedMember> members;  // from head to nut
    int group = -1;                      // node joint_ID
};

struct JointSearch {
    std::vector<JointCandidate> joints;
    std::vector<std::string> remarks;  // also one for each bolt or nut that is in no joint, with the reason
};

// `parts` as in the document. Ids come from groups that are named joint_ID; other joints are J1, J2 … by
// position.
JointSearch find_joints(const Tree& tree, const std::vector<PartGeometry>& parts);

// Gives every joint its node joint_ID, at the seat and +Y along the axis, with ID_bolt, ID_washer_head,
// ID_washer_nut and ID_nut under it. A group of the file's own stays where it is.
void group_joints(Tree& tree, JointSearch& search);

}  // namespace bolt::step_import
