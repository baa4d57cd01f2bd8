// The plot of a pull: torque over the nut's angle, and the window that it is to end in.
#pragma once

#include <optional>
#include <vector>

#include "game/lesson/lesson.hpp"

namespace bolt::trainer {

struct PlotPoint {
    float angle = 0.0F;   // deg
    float torque = 0.0F;  // N·m
};

struct Plot {
    std::vector<PlotPoint> points;  // of the joint that the wrench was on last
    int joint = -1;                 // none before the wrench was on a nut
    std::optional<content::Window>
        aim;  // N·m: the due step's, else what the joint is to have; loosening: none
};

// Adds a tick with the wrench, after the lesson has observed it.
void note(Plot& plot, const lesson::Lesson& lesson,
          const ecs::Access<const world::Joint, const world::ToolContact>& world);

}  // namespace bolt::trainer
