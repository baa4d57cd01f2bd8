// The result of a lesson: the verdict on each joint, the score, and the display of a torque wrench.
#pragma once

#include <cstddef>

#include "game/lesson/lesson.hpp"
#include "game/lesson/result.hpp"
#include "game/world/world.hpp"

namespace bolt::lesson {

// The display of an electronic torque wrench. `value` is the torque that the wrench measures, N·m (less than
// that at the nut if an adaptor lengthens the lever); in a step of kind `turn` it is the angle from the mark,
// degrees. `target` compares it with the window of the due step. Both have their defaults while the wrench is
// not on a nut.
struct ToolReading {
    double value = 0.0;
    world::TargetState target = world::TargetState::below;
};
ToolReading tool_reading(const Lesson& lesson, const world::ReadHaptics& world);

// The current result of one joint.
JointResult judge_joint(const Lesson& lesson, std::size_t joint, const world::ReadJoints& world);
// The current result of the lesson, with score and reasons. `dt`: tick length, s.
LessonResult judge(const Lesson& lesson, const world::ReadHaptics& world, double dt);

}  // namespace bolt::lesson
