// The close-up: a small picture in a corner, as an eye on the wrench sees jaw and nut while they are near
// each other.
#pragma once

#include <optional>
#include <span>

#include "engine/base/math.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/renderer.hpp"
#include "engine/ui/ui.hpp"

namespace bolt::trainer {

struct ActiveLesson;

struct CloseUp {
    bool wished = false;               // by whoever plays, or by the lesson's mode
    std::optional<std::size_t> joint;  // that the tool is near to; none: nothing is shown
    bool wrench = false;               // for which the eye was chosen, or for fingers
    Quat chosen{1.0, 0.0, 0.0, 0.0};   // the tool's orientation then
    Pose tool;                         // m, at work
    Vec3 eye{0.0};                     // m, in its frame
    double seen = 0.0;                 // 0 … 1, of nut and jaw, when it was chosen
};

// Whether there is one in this frame, and from where.
void update_close_up(ActiveLesson& playing);

// px: in the lower left corner, over where the strain stands if that is too near; none where all of it is
// taken.
std::optional<render::Rectangle> close_up_place(const glm::dvec2& picture, float scale,
                                                std::span<const render::Rectangle> taken);

// Draws it with the interface, after all else of that. Nothing where nothing is to be shown.
struct Drawing {
    render::Renderer& renderer;
    gpu::FrameContext& frame;
    ui::Ui& ui;
};
Status draw_close_up(const Drawing& on, const ActiveLesson& playing, const glm::dvec2& picture, float scale);

}  // namespace bolt::trainer
