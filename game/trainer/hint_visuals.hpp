// Visuals of a hint in the scene: an arrow for the motion, and ghosts of hand and wrench.
#pragma once

#include <optional>

#include "game/lesson/hints.hpp"
#include "game/scene/annotations.hpp"
#include "game/trainer/active_lesson.hpp"

namespace bolt::trainer {

// Colours of arrows towards the work and away from it. Amber and blue remain distinct with red-green colour
// blindness.
inline constexpr glm::vec4 forward_color{1.0F, 0.78F, 0.1F, 1.0F}, backward_color{0.3F, 0.72F, 1.0F, 1.0F};

// Geometry of a motion.
struct MotionGeometry {
    const servo::NutGeometry& nut;
    Vec3 nut_centre{0.0};        // m
    Pose tool;                   // the tool in the hand
    Pose rest;                   // where the wrench lies
    double handle_length = 0.0;  // m
    bool loosens = false;        // the step loosens the nut
};

// The arrow of a motion; none for HintMotion::none:
//   turn                    round, about the bolt; clockwise from above to tighten a right-hand thread
//   approach, lift, let go  straight, along the bolt
//   second wrench           straight, along the bolt to the held part
//   take, put away          straight, down to the resting place of the wrench
std::optional<scene::MotionArrow> arrow_of(lesson::HintMotion motion, const MotionGeometry& geometry);

// The ghosts of an animated motion (level 3 of a hint). They move for `ghost_motion_time`, rest at the end of
// the motion, and begin again.
inline constexpr double ghost_motion_time = 1.2, ghost_rest_time = 0.6;  // s
// The share of the motion, 0 … 1, that is done `time` seconds after a beginning.
double ghost_share(double time);
// The pose of a ghost at that share of the motion. `target`: the pose in which an approach ends and in which
// a turn or a lift begins; the ghost at level 2 of the hint stands there.
Pose animated_ghost(lesson::HintMotion motion, const Pose& target, const MotionGeometry& geometry,
                    double share);

// Shows the visuals of `hint`; null hides all.
void show_hint_visuals(scene::SceneWorld& world, ActiveLesson& active, const lesson::Hint* hint);

}  // namespace bolt::trainer
