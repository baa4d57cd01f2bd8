// What lies over a lesson's picture: what to do, and the pull as a curve. Figures that belong to a place
// stand there, in the scene (label_system).
#pragma once

#include "game/lesson/controls.hpp"
#include "game/trainer/active_lesson.hpp"

namespace bolt::trainer {

// In whose language, and by which keys.
struct Said {
    const words::Words* words = nullptr;
    const lesson::Controls* controls = nullptr;
};

// Between ui::Ui::begin and end. `scale`: pixels a point.
void draw_hud(const ActiveLesson& playing, const Said& said, const glm::dvec2& size, float scale);

}  // namespace bolt::trainer
