// The tools that may turn a joint, by their kind, size and strength. No model is needed.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "game/tool_models/parameters.hpp"
#include "haptics/collision/tool_head.hpp"
#include "tools/author/geometry/messages.hpp"

namespace bolt::geometry {

// Indices in Assembly::tools of the tools that a joint is checked with. A joint with a tool of its own is
// checked with this tool. Any other joint is checked with the default tool and with the tools that no joint
// names, each replaced by the tool that its `instead` names for this joint. The first index is the tool of a
// lesson whose user has chosen none.
std::vector<std::size_t> tools_of_joint(const content::Assembly& assembly, std::size_t joint);

// The part that the tool of a joint grips, as lessons represent it.
collision::TurnedShape shape_of(const joint::JointDesign& design);

// m, the width across flats that a tool is made for.
double nominal_size(const content::WrenchDesign& design);

// The kind of a tool with its size: "an open end of 13 mm", "a hexagon bit of 6 mm".
std::string title_of(const content::WrenchDesign& design);

// "the wrench", "the tool "ring"". `tool`: index in Assembly::tools.
std::string name_of_tool(const content::Assembly& assembly, std::size_t tool);

// Designs of common tools, with common lengths, of the kinds that can turn the part of a joint.
std::vector<content::WrenchDesign> usual_tools(const joint::JointDesign& design);

// Reports each tool that cannot grip the part of a joint, has another size, or bears less than the joint's
// target torque. Reports each pair of joint type and tool once.
void check_tools(const content::Assembly& assembly, const Messages& messages);

// Returns true if the tool can grip the part and is made for its size.
bool suits(const content::WrenchDesign& design, const joint::JointDesign& joint);

}  // namespace bolt::geometry
