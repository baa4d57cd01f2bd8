// What a guiding force needs to know of tool and nut (force/guide.hpp).
#pragma once

#include "haptics/force/guide.hpp"
#include "haptics/servo/engagement.hpp"

namespace bolt::servo {

force::GuidedTool guided_tool(const Setup& setup, const ToolPose& tool);

// `joint` below 0, or none of the setup's: no goal.
force::GuideGoal goal_at(const Setup& setup, std::span<const joint::JointState> joints, int joint);

}  // namespace bolt::servo
