// The protractor at a nut that is turned by an angle: a scale of degrees that rests on the joint, the window
// in which to stop, and a pointer that turns with the nut from the mark.
#pragma once

#include <optional>
#include <vector>

#include "engine/assets/model.hpp"
#include "game/lesson/lesson.hpp"
#include "game/scene/workplace.hpp"
#include "game/view/labels.hpp"

namespace bolt::scene {

// The windows of all steps that turn a nut by an angle, each once; none if the lesson has no such step.
std::vector<DialWindow> dial_windows(const content::Assembly& assembly);

// Generates the meshes: scale and pointer (DialShape), then one for each window. The mark is on +X at radius
// 1, and angles grow clockwise seen from +Z.
assets::Model dial_model(const std::vector<DialWindow>& windows);

// A protractor to show.
struct Dial {
    glm::dmat4 world{1.0};  // from the meshes' frame to the assembly's
    double angle = 0.0;     // rad from the mark to the pointer, with the sign of DialWindow
    DialWindow window;
    bool shows_window = false;
    glm::vec4 window_color{1.0F}, pointer_color{1.0F};
};

// The protractor of the due step; none if no nut is due to be turned by an angle, or the nut has no mark yet.
// An assessment shows no window, and its pointer has one colour.
std::optional<Dial> dial_of(const lesson::Lesson& lesson, const servo::Setup& setup,
                            const ecs::Access<const world::Joint>& joints, const view::Palette& palette = {});

// Shows `dial` in place of the one before; an empty one hides it.
void show_dial(SceneWorld& world, const std::optional<Dial>& dial);

}  // namespace bolt::scene
