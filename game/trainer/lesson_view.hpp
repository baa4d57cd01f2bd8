// Camera, close-up and labels of a lesson; view_system() and label_system() of active_lesson.hpp are
// implemented beside them. The close-up is a small picture in a corner that shows jaw and nut from an eye on
// the wrench while they are near each other.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/renderer.hpp"
#include "engine/ui/ui.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/view/camera.hpp"

namespace bolt::trainer {

struct ActiveLesson;

struct CloseUp {
    bool wanted = false;                          // by the trainee or by the lesson's mode
    std::optional<std::size_t> joint;             // near the tool; none: no close-up is shown
    bool with_wrench = false;                     // the eye was chosen for the wrench; false: for fingers
    Quat chosen_orientation{1.0, 0.0, 0.0, 0.0};  // of the tool, when the eye was chosen
    Pose tool;                                    // wrench or fingers
    Vec3 eye{0.0};                                // m, in the tool's frame
    double visibility = 0.0;  // 0 … 1, visible fraction of nut and jaw, when the eye was chosen
};

struct LessonView {
    view::CameraGlide camera;
    motion::VisibilityModel visibility;
    bool help = true;          // the program finds a view of the due joint
    double out_of_view = 0.0;  // s since the joint at work, else the due one, was last visible
    CloseUp close_up;
    bool clamp_map = false;                   // show the clamp force of every joint
    std::vector<render::Rectangle> occupied;  // px, areas of the interface in the previous picture
    std::optional<Pose> head;  // of the user in a room, assembly frame; none: the camera shows the lesson
    // The rotation about the vertical from the user's frame in a room to the assembly's; none: in a window.
    std::optional<Quat> heading;
};

// Determines whether the close-up is shown in this frame, and its eye.
void update_close_up(ActiveLesson& active);

// The area of the close-up, px: in the lower left corner, above the effort bar if that is too near. None if
// the corner is occupied. `scale`: px per point.
std::optional<render::Rectangle> close_up_rectangle(const glm::dvec2& picture, float scale,
                                                    std::span<const render::Rectangle> occupied);

struct DrawContext {
    render::Renderer& renderer;
    gpu::FrameContext& frame;
    ui::Ui& ui;
};

// Draws the close-up, if one is shown, after the rest of the interface.
Status draw_close_up(const DrawContext& context, const ActiveLesson& active, const glm::dvec2& picture,
                     float scale);

}  // namespace bolt::trainer
