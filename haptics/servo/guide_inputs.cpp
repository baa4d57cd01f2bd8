#include "haptics/servo/guide_inputs.hpp"

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
    const NutGeometry& nut = setup.nuts[i];
    const double angle = joints[i].nut.angle;
    goal.id = joint;
    goal.target.point = nut_centre(nut, angle);
    goal.target.axis = nut.axis;
    // The ball that the target's own nut and bolt end fill; its corners are 0.58 across_flats away.
    goal.target.shell = 1.2 * std::max(nut.height, nut.across_flats);
    // Tightening a right-hand thread turns about −axis.
    goal.hexagon = {nut.axis, std::cos(angle) * nut.e1 - std::sin(angle) * nut.e2,
                    std::sin(angle) * nut.e1 + std::cos(angle) * nut.e2};
    return goal;
}

}  // namespace bolt::servo
