// The tool and nut as the guiding force takes them (haptics/force/guide.hpp).
#pragma once

#include "haptics/force/guide.hpp"
#include "haptics/servo/engagement.hpp"

namespace bolt::servo {

force::GuidedTool guided_tool(const Setup& setup, const ToolPose& tool);

// The nut of `joint` at its present angle. Returns a goal with id −1 if `joint` is not an index of
// setup.nuts.
force::GuideGoal goal_at(const Setup& setup, std::span<const joint::JointState> joints, int joint);

}  // namespace bolt::servo
