// A lesson under way: the session, the world, and by concern what the systems of a frame (systems.hpp) keep
// from frame to frame.
#pragma once

#include <memory>
#include <string>

#include "engine/ecs/system.hpp"
#include "engine/render/overlay.hpp"
#include "engine/text/fonts.hpp"
#include "game/lesson/feedback.hpp"
#include "game/lesson/hints.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/scene/postures.hpp"
#include "game/scene/systems.hpp"
#include "game/session/lesson_session.hpp"
#include "game/sound/playback.hpp"
#include "game/trainer/controls.hpp"
#include "game/trainer/hud.hpp"
#include "game/trainer/lesson_view.hpp"
#include "game/trainer/mouse_hand.hpp"
#include "game/trainer/pointing.hpp"
#include "game/trainer/station_client.hpp"
#include "game/trainer/step_undo.hpp"
#include "game/view/camera.hpp"
#include "game/view/labels.hpp"
#include "game/world/world.hpp"

namespace bolt::trainer {

// What the pointer means.
struct Pointing {
    bool drags_hand = false;         // the left button moves the hand, not the view
    glm::dvec2 press{0.0};           // px, where the left button went down
    std::optional<std::size_t> nut;  // below the pointer
    bool wrench = false;             // the wrench lies below the pointer or beside the hand
};

// The lesson's time against the clock's.
struct Pace {
    double owed = 0.0;    // s of ticks that are due
    double lagged = 0.0;  // s that a slow machine fell behind the clock
    bool paused = false, finished = false;
};

// How the work is seen.
struct LessonView {
    view::Glide camera;
    motion::Sight sight;
    double unseen = 0.0;  // s that the due joint has been out of sight
    CloseUp close_up;
    bool clamp_map = false;                   // every joint shows its clamp force
    std::vector<render::Rectangle> occupied;  // px, areas of the interface in the picture before
};

// What the trainee is told.
struct Coaching {
    lesson::Hints hints;
    lesson::Mistakes mistakes;
    std::optional<std::pair<std::size_t, Pose>> ghost;  // of the wrench: its step and its pose
};

struct LessonSound {
    std::unique_ptr<sound::Live> live;  // null: no sound was asked for
    bool quiet = false;
    double volume = 1.0;               // 0 … 1, from the trainee's settings
    sound::Ear ear;                    // of the captions
    std::optional<Captions> captions;  // none: not asked for
};

struct ActiveLesson {
    std::unique_ptr<session::Course> course;
    std::optional<StationClient> station;  // none: the mouse moves the hand
    MouseHand mouse;
    scene::Workplace place;  // with the world
    render::Scene scene;

    scene::Postures postures;
    std::size_t grip = 0;  // how the handle is held (scene::Postures)
    Vec3 shoulder{0.0};    // m, of the trainee
    scene::Strain strain;  // of the hand
    view::Palette palette;

    Controls controls;
    Pointing pointing;
    Pace pace;
    LessonView view;
    Coaching coaching;
    LessonSound sound;
    StepUndo undo;  // pending until the hand is off the nut
    Plot plot;
    std::vector<lesson::Verdict> verdicts;  // of the joints, once the lesson has ended
    std::vector<lesson::Event> events;      // since they were last logged
};

// The work as haptic_system has written it.
inline const world::Hand& hand_of(const ActiveLesson& p) { return p.place.world.only<world::Hand>(); }
inline const world::Tool& tool_of(const ActiveLesson& p) { return p.place.world.only<world::Tool>(); }
inline const world::ToolContact& contact_of(const ActiveLesson& p) {
    return p.place.world.only<world::ToolContact>();
}

// What happens in a frame of a lesson, in order.

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
