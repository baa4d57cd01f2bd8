// SVG drawings of all joints of an assembly: maps, seen along the bolts, and rows of clamp forces.
#pragma once

#include <string>
#include <vector>

#include "game/analysis/session_data.hpp"
#include "game/plot/svg.hpp"

namespace bolt::report {

// Positions of the joints in the units of a drawing, seen from the nuts and scaled to the width; the height
// follows. `margin`: between the outermost positions and the border.
struct JointMapLayout {
    std::vector<plot::SvgPoint> positions;  // by joint
    double width = 480.0, height = 200.0;
    double radius = 12.0;  // of a joint's disc; neighbouring discs do not touch
};
JointMapLayout joint_map_layout(const content::Assembly& assembly, double width, double margin);

// The planned and the actual order of one pass.
std::string order_map(const analysis::SessionData& session, const analysis::PassOrder& order);

// The clamp force of each joint against its target.
std::string clamp_map(const analysis::SessionData& session);

// One row per joint: the clamp force when the hand last left the nut and at the end of the lesson, the
// target, and the mean of all joints.
std::string clamp_rows(const analysis::SessionData& session);

// Returns true if a row shows a difference between the forces at the release and at the end.
bool has_release_differences(const analysis::SessionData& session);

}  // namespace bolt::report
