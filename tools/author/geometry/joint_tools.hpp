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

// The part that the tool of a joint grips, as lessons represent it.
collision::TurnedShape shape_of(const joint::JointDesign& design);

// The kind of a tool with its size: "an open end of 13 mm", "a hexagon bit of 6 mm".
std::string title_of(const content::WrenchDesign& design);

// "the wrench", "the tool "ring"". `tool`: index in Assembly::tools.
std::string name_of_tool(const content::Assembly& assembly, std::size_t tool);

// Designs of common tools, with common lengths, of the kinds that can turn the part of a joint.
std::vector<content::WrenchDesign> usual_tools(const joint::JointDesign& design);

// Reports each tool that cannot grip the part of a joint, has another size, or bears less than the highest
// torque that is judged OK. Reports each pair of joint type and tool once.
void check_tools(const content::Assembly& assembly, const Messages& messages);

}  // namespace bolt::geometry
