// The tools of a drafted assembly: one for each width across flats of its heads, nuts and sockets.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "haptics/joint/design.hpp"

namespace bolt::step_import {

// The properties of a joint that determine its tool.
struct ToolNeed {
    joint::HeadShape head = joint::HeadShape::hexagon;  // socket: the tool is a key or a bit
    double across_flats = 0.0;                          // m
    double thread = 0.0;                                // m, nominal diameter; a larger screw needs a ratchet

    friend bool operator==(const ToolNeed&, const ToolNeed&) = default;
};

struct DraftTool {
    ToolNeed need;
    std::size_t joints = 0;  // that it turns
    std::string name;        // in "more_tools"; empty: the tool of all joint types that name none
    std::string json;        // an object
    std::string words;       // "a hexagon key of 6 mm, 86 mm from the screw to the grip"
};

// One tool for each need; `needs` has one entry a joint. The tool of most joints comes first and has no name.
// Of more kinds than an assembly can have tools, the rarest are left out.
std::vector<DraftTool> draft_tools(const std::vector<ToolNeed>& needs);

}  // namespace bolt::step_import
