// The torque, the angle, the yield, the click and the second wrench that a step of a lesson requires.
#pragma once

#include <cstddef>

#include "content/format/assembly.hpp"
#include "game/lesson/lesson.hpp"
#include "game/world/world.hpp"

namespace bolt::lesson {

// The torque window of a step: the joint's window, scaled so that its target is LessonStep::torque.
content::ToleranceWindow torque_window(const Lesson& lesson, const LessonStep& step);

// The angle, rad, by which the nut has been turned from the mark, or 0 without a mark.
double angle_from_mark(const Lesson& lesson, const world::ReadJoints& world, std::size_t joint);

// True if the step tightens to the whole target with strategy `yield`.
bool requires_yield(const Lesson& lesson, const LessonStep& step);

// True if a second wrench must keep the held part of the joint from turning; never under the published law.
bool needs_second_wrench(const content::Assembly& assembly, std::size_t joint);
bool needs_second_wrench(const content::Assembly& assembly);  // any of its joints

// True if only the click of the torque wrench ends the step. This is so under the published law: there the
// torque grows so slowly in the yield stage that a stroke can end inside the torque window before the click.
// False if a wrench within its tolerance might not click at this set torque (sessions before format 6).
bool requires_click(const Lesson& lesson, const LessonStep& step);

// Set torque of the torque wrench for the due step, N·m on its scale; 0: none (LessonStep::set_torque).
inline double wrench_set_torque(const Lesson& lesson) {
    const LessonStep* step = lesson.due();
    return step == nullptr ? 0.0 : step->set_torque;
}

}  // namespace bolt::lesson
