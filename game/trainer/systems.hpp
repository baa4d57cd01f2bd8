// What happens in a frame of a lesson, in order.
#pragma once

#include "engine/ecs/schedule.hpp"
#include "game/trainer/active_lesson.hpp"

namespace bolt::trainer {

struct Frame {
    ActiveLesson& playing;
    const words::Words& words;
    double seconds = 0.0;  // since the last one, as far as anything moves by it
    double late = 0.0;     // s that it took longer than that: a slow machine
    glm::dvec2 size{1.0};  // px, of the picture
    Wanted wanted;
    const text::Fonts* fonts = nullptr;
    Status status;  // the first error: the session could not be kept
};

// Before the systems: what mouse and keys ask of the hand and of the view, read off the world of the frame
// before.
void read_pointer(const scene::World& world, Frame& frame);

void haptic_system(scene::World& world, Frame& frame);  // the servo's snapshot of every tick, as components
void placement_system(scene::World& world,
                      Frame& frame);  // nuts, wrench and hand where the components have them
void lesson_system(scene::World& world, Frame& frame);   // what is due is marked, what happened is said
void view_system(scene::World& world, Frame& frame);     // the camera, and what fades before the nut
void label_system(scene::World& world, Frame& frame);    // figures at the wrench and at the joints
void present_system(scene::World& world, Frame& frame);  // everything to the renderer

inline constexpr ecs::System<scene::World, Frame> frame_systems[] = {
    {"haptics", haptic_system}, {"placement", placement_system}, {"lesson", lesson_system},
    {"view", view_system},      {"labels", label_system},        {"present", present_system}};

// The picture as the camera has it now.
Screen screen_of(const ActiveLesson& playing, const glm::dvec2& size);

}  // namespace bolt::trainer
