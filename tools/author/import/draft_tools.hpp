// The tools of a drafted assembly: one for each width across flats of its heads, nuts and sockets.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::step_import {

// Width, m, of the largest socket that gets a plain hexagon key: that of M8, whose full torque needs about
// 300 N at the grip. A wider socket gets a bit on a ratchet.
inline constexpr double largest_key = 6.0 * mm;

// The properties of a joint that determine its tool.
struct ToolNeed {
    joint::HeadShape head = joint::HeadShape::hexagon;  // socket: the tool is a key or a bit
    double across_flats = 0.0;                          // m; a socket above largest_key needs a ratchet
    double thread = 0.0;                                // m, nominal diameter

    friend bool operator==(const ToolNeed&, const ToolNeed&) = default;
};

struct DraftTool {
    ToolNeed need;
    std::size_t joints = 0;   // number of joints that it turns
    std::string name;         // in "more_tools"; empty: the tool of all joint types that name none
    std::string json;         // an object
    std::string description;  // "a hexagon key of 6 mm, 86 mm from the screw to the grip"
};

// Returns one tool for each distinct need; `needs` has one entry a joint. The tool that turns the most joints
// comes first and has no name. If there are more distinct needs than an assembly may have tools, the rarest
// needs get no tool.
std::vector<DraftTool> draft_tools(const std::vector<ToolNeed>& needs);

}  // namespace bolt::step_import
