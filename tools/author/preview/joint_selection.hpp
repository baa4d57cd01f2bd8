// Finds the joint that the author clicks in the preview, and its entry in assembly.json.
#pragma once

#include <glm/vec2.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/view/camera.hpp"
#include "game/view/loaded_model.hpp"
#include "tools/author/geometry/bvh.hpp"

namespace bolt::author {

struct SelectableJoint {
    std::string id, node;
    std::string location;     // FILE:LINE:COLUMN of its entry
    std::string description;  // its type and the tool that turns it
};

// The joints of a shown assembly and the triangles that a click may hit; empty for a bare model.
struct SelectableJoints {
    std::vector<SelectableJoint> joints;  // in the order of the file
    geometry::Bvh triangles;              // Triangle::part: index in `joint_of_part`
    std::vector<int> joint_of_part;       // index in `joints`; -1: the part belongs to no joint
    std::vector<std::string> variants;    // names of all variants; first an empty one if none is the default
    std::string variant;                  // name of the shown one; empty: the file has none
};

// `source`, `variant`: of the preview; `model`: what view::load_model() read from them. Fails if the file has
// become invalid since then.
Result<SelectableJoints> find_joints(const std::string& source, const std::string& variant,
                                     const view::LoadedModel& model);

// Returns null if there is no joint of that name.
const SelectableJoint* joint_named(const SelectableJoints& joints, std::string_view id);

// The joint whose part is the first one behind a point of the picture; null if that part belongs to no joint
// or there is none. `at`: in units of the picture's height, from its middle, x to the right, y up.
const SelectableJoint* joint_at(const SelectableJoints& joints, const view::Orbit& camera, glm::dvec2 at);

// "assembly.json:44:5: joint B1: type M8x30, tool wrench\n"
std::string selection_line(const SelectableJoint& joint);

}  // namespace bolt::author
