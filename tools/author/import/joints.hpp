// Finds joints by their geometry: a hexagon bolt or a cap screw with a nut on its axis, or screwed into a
// part, a stud with a nut that is screwed into a part, and the washers and parts between.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/joint/design.hpp"
#include "tools/author/import/clamped_members.hpp"
#include "tools/author/import/tree.hpp"

namespace bolt::step_import {

inline constexpr std::string_view joint_prefix = "joint_";  // of a node's name

// Scene frame.
struct JointCandidate {
    std::string id;
    std::string size;  // "M16", "M16x1.5"
    // The direction of the drawn helix; right if no helix is drawn.
    joint::ThreadDirection thread_direction = joint::ThreadDirection::right;
    joint::HeadShape head = joint::HeadShape::hexagon;
    double bolt_length = 0.0;  // m, under the head; of a stud without its end in the tapped part
    // m, distance from the head to the nut or the tapped part, of a stud from nut to tapped part, without the
    // washers
    double grip = 0.0;
    bool turned_at_head = false;  // of a hexagon bolt with a nut: its head is turned, not its nut
    // Centre of the hole, m, on the face of the member under the nut or head that is turned.
    Vec3 seat{0.0};
    Vec3 axis{0.0, 1.0, 0.0};  // from the members to the nut or head that is turned
    int bolt = -1, nut = -1;   // nodes; a screw has no nut
    int tapped = -1;  // node of the part that a screw or a stud is screwed into; −1 for a through-bolt
    // Length of the thread in that part, m; 0: a screw that ends inside the part, so its whole length beyond
    // members and washers engages.
    double engagement = 0.0;
    std::vector<int> head_washers, nut_washers;
    std::vector<ClampedMember> members;  // from head to nut or tapped part; of a stud from tapped part to nut
    int group = -1;                      // node joint_ID

    [[nodiscard]] bool is_screw() const { return tapped >= 0 && nut < 0; }
    [[nodiscard]] bool is_stud() const { return tapped >= 0 && nut >= 0; }
    // Cap screws are turned at the head, with a key, even if they have a nut.
    [[nodiscard]] bool turns_head() const {
        return is_screw() || head == joint::HeadShape::socket || turned_at_head;
    }
};

struct JointSearchResult {
    std::vector<JointCandidate> joints;
    std::vector<std::string> remarks;  // include the reason for each bolt or nut without a joint
};

// `parts`: by part of the document. A group named joint_ID in the file gives the id; other joints are
// numbered J1, J2 … by position. A hexagon bolt with a nut is turned at its nut, unless the origin of its
// group is on the seat of its head.
JointSearchResult find_joints(const Tree& tree, const std::vector<PartGeometry>& parts);

// Turns the hexagon bolts of these joints at their heads; "all": of all joints that can. Fails if an id is
// unknown, or its joint is not a hexagon bolt with a nut.
Status turn_at_heads(JointSearchResult& search, std::span<const std::string> ids);

// Gives every joint a node joint_ID, at the seat with +Y along the axis, and moves its fasteners under it as
// ID_bolt, ID_washer_head, ID_washer_nut and ID_nut (not of a screw). A group that exists in the file keeps
// its pose. Implemented in joint_nodes.cpp.
void add_joint_nodes(Tree& tree, JointSearchResult& search);

}  // namespace bolt::step_import
