// What a hint shows in the scene beside its words: an arrow for the motion, ghosts of hand and wrench.
#pragma once

#include <optional>

#include "game/lesson/hints.hpp"
#include "game/scene/annotations.hpp"
#include "game/trainer/active_lesson.hpp"

namespace bolt::trainer {

// Towards the work, and away from it; amber and blue are two colours also with no red or green cones.
inline constexpr glm::vec4 forth_color{1.0F, 0.78F, 0.1F, 1.0F}, back_color{0.3F, 0.72F, 1.0F, 1.0F};

// Where a motion is made.
struct MotionPlace {
    const servo::NutGeometry& nut;
    Vec3 middle{0.0};  // m, of the nut
    Pose tool;         // on the nut, or what is in the hand
    Pose rest;         // where the wrench lies
    double handle_length = 0.0;
    bool loosens = false;  // the step
};

// None for no motion. About the bolt where something turns, clockwise from above to tighten; straight along
// it to where the tool goes or comes from; down to where the wrench lies.
std::optional<scene::Arrow> arrow_of(lesson::Motion motion, const MotionPlace& place);

// Of the hint, none: all of them go.
void show_hint_visuals(scene::World& world, ActiveLesson& playing, const lesson::Hint* hint);

}  // namespace bolt::trainer
