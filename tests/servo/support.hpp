// A small assembly for servo tests: two M16 joints, nuts on top, 0.2 m apart.
#pragma once

#include <vector>

#include "haptics/servo/tick.hpp"
#include "tests/joint/support.hpp"

namespace bolt::test {

inline servo::Setup two_joints(const force::OutputLimits& limits = {}, Vec3 axis = Vec3(0, 1, 0),
                               joint::ThreadDirection thread = joint::ThreadDirection::right) {
    std::vector<joint::JointDesign> designs(2, m16_flange_joint());
    designs[1].seat = Vec3(0.2, 0.0, 0.0);
    for (joint::JointDesign& d : designs) {
        d.axis = axis;
        d.thread_direction = thread;
    }
    servo::SetupDescription description;
    description.joints = designs;
    description.tool.head = collision::make_jaw(24.2e-3, to_radians(15.0));
    description.tool.head_angle = to_radians(15.0);
    description.tool.handle_length = 0.23;
    description.max_torque = 210.0;
    description.limits = limits;
    return servo::make_setup(description);
}

// A command for a tool at a position, with its handle at `angle` (rad) about the nut's axis (tightening
// positive), upright or flipped.
inline servo::CommandedTool tool_at(const servo::NutGeometry& nut, const Vec3& position, double angle,
                                    bool flipped = false) {
    const Vec3 x = servo::direction_at(nut, angle);
    const Vec3 z = flipped ? -nut.axis : nut.axis;
    const Quat q = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z)));
    servo::CommandedTool commanded;
    for (int i = 0; i < 3; ++i) commanded.position[i] = static_cast<float>(position[i]);
    commanded.orientation[0] = static_cast<float>(q.w);
    commanded.orientation[1] = static_cast<float>(q.x);
    commanded.orientation[2] = static_cast<float>(q.y);
    commanded.orientation[3] = static_cast<float>(q.z);
    return commanded;
}

inline servo::TickInput holding(servo::Grip grip, const servo::CommandedTool& commanded) {
    servo::TickInput input;
    input.dead_man = true;
    input.grip = grip;
    input.commanded_tool = commanded;
    return input;
}

}  // namespace bolt::test
