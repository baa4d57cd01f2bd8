#include "haptics/servo/lead.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::servo {

force::GuidedTool guided_tool(const Setup& setup, const ToolPose& tool) {
    const Vec3 across = glm::cross(tool.normal, tool.handle);
    const Vec3 jaw =
        std::cos(setup.wrench.head_angle) * tool.handle + std::sin(setup.wrench.head_angle) * across;
    return {tool.position, jaw, tool.normal};
}

force::GuideGoal goal_at(const Setup& setup, std::span<const joint::JointState> joints, int joint) {
    force::GuideGoal goal;
    const auto i = static_cast<std::size_t>(joint);
    if (joint < 0 || i >= setup.nuts.size()) return goal;
    const NutPlace& nut = setup.nuts[i];
    const double angle = joints[i].nut.angle;
    goal.id = joint;
    goal.target.point = nut_centre(nut, angle);
    goal.target.axis = nut.axis;
    // Half a nut and the bolt's end above it, and a corner's radius: what is its own.
    goal.target.shell = 1.2 * std::max(nut.height, nut.across_flats);
    // A tightening turn is one about -axis.
    goal.hexagon = {nut.axis, std::cos(angle) * nut.e1 - std::sin(angle) * nut.e2,
                    std::sin(angle) * nut.e1 + std::cos(angle) * nut.e2};
    return goal;
}

}  // namespace bolt::servo
