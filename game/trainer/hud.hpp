// What lies over a lesson's picture: what to do, and the pull as a curve. Figures that belong to a place
// stand there, in the scene (label_system).
#pragma once

#include "game/trainer/playing.hpp"

namespace bolt::trainer {

// Between ui::Ui::begin and end. `scale`: pixels a point.
void draw_hud(const Playing& playing, const glm::dvec2& size, float scale);

}  // namespace bolt::trainer
