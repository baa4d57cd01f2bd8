// A lesson in progress, in a window or in a room: its session, its world, and the state that the systems of a
// frame keep from frame to frame.
#pragma once

#include <functional>
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
#include "game/trainer/helped_hand.hpp"
#include "game/trainer/hud.hpp"
#include "game/trainer/instruction.hpp"
#include "game/trainer/lesson_view.hpp"
#include "game/trainer/pointing.hpp"
#include "game/trainer/station_client.hpp"
#include "game/trainer/step_undo.hpp"
#include "game/view/camera.hpp"
#include "game/view/labels.hpp"
#include "game/world/world.hpp"
#include "haptics/servo/vibration.hpp"

namespace bolt::trainer {

// The target of the pointer.
struct PointerState {
    bool drags_hand = false;         // the drag of the left button moves the hand, not the view
    glm::dvec2 press_position{0.0};  // px, where the left button was pressed
    // The nut under the pointer. With the free hand only a nut that the hand is beside counts; with a device
    // or a tracked hand there is none.
    std::optional<std::size_t> nut;
    // A click would pick up the wrench, which lies at its resting place. With the helped hand the wrench must
    // be under the pointer; with a device or a tracked hand it must be within reach of the hand; with the
    // free hand both.
    bool can_take_wrench = false;
};

// Lesson time compared with real time.
struct LessonClock {
    double pending = 0.0;  // s of ticks that remain to be stepped
    double lag = 0.0;      // s by which a slow machine has fallen behind real time
    bool paused = false, finished = false;
};

// Help for the trainee.
struct Guidance {
    lesson::HintState hints;
    lesson::MistakeState mistakes;
    // Cached for one step: its index, and the pose of the wrench's ghost on the nut. None: not computed.
    std::optional<std::pair<std::size_t, Pose>> wrench_ghost;
    InstructionState instruction;
};

// The force on the dragged hand, which an arrow shows because a mouse renders no force.
struct ForceDisplay {
    bool enabled = true;  // from the trainee's settings
    Vec3 force{0.0};      // N, smoothed, on the hand, assembly frame
};

struct LessonSound {
    std::unique_ptr<sound::LiveSound> live;  // null: no sound
    bool muted = false;
    double volume = 1.0;               // 0 … 1, from the trainee's settings
    sound::EventDetector detector;     // for the captions and the vibration
    std::optional<Captions> captions;  // none: disabled
};

// Vibration of the controller in the working hand (docs/vibration.md).
struct LessonVibration {
    servo::VibrationOptions options;
    servo::VibrationState state;
};

struct ActiveLesson {
    std::unique_ptr<session::LessonSession> session;
    std::optional<StationClient> station;  // none: the helped hand moves the tool
    HelpedHand helped_hand;
    scene::Workplace workplace;  // contains the world
    render::Scene scene;

    std::vector<scene::Postures> postures;  // one for each of servo::Setup::tools
    std::size_t handle_posture_index = 0;   // the posture of the hand on the handle, in Postures::on_handle
    Vec3 shoulder{0.0};                     // m, the trainee's, in the assembly's frame
    scene::Effort effort;                   // how hard the drawn hand strains (scene/postures.hpp)
    view::Palette palette;

    InputState input;
    PointerState pointer;
    LessonClock clock;
    LessonView view;
    Guidance guidance;
    ForceDisplay force;
    LessonSound sound;
    LessonVibration vibration;
    StepUndo undo;
    std::int16_t second_wrench = -1;  // joint whose held part it is on; −1: none
    TorquePlot plot;
    std::vector<lesson::Verdict> verdicts;    // of the joints, after the end of the lesson
    std::vector<lesson::LessonEvent> events;  // not logged yet
};

// The component of the hand. haptic_system writes it in each tick, and at the end of the frame's ticks
// write_hand() (active_lesson.cpp) replaces it by the hand of the mouse or of the station. So after a frame
// it has what only these know, such as where the hand goes next.
inline const world::WorkingHand& hand_of(const ActiveLesson& active) {
    return active.workplace.world.only<world::WorkingHand>();
}
// The postures of the hand at the tool in use.
inline const scene::Postures& postures_of(const ActiveLesson& active) {
    return active.postures[active.session->setup().tool];
}
// Components of the tool after the last tick.
inline const world::ConstrainedTool& tool_of(const ActiveLesson& active) {
    return active.workplace.world.only<world::ConstrainedTool>();
}
inline const world::ToolState& tool_state_of(const ActiveLesson& active) {
    return active.workplace.world.only<world::ToolState>();
}

// The trainee's head and hands in a room, for a headset or projection walls.
struct RoomInput {
    Pose room_in_assembly;  // the room's frame in the assembly's
    Pose head;              // in the room
    // Rotation about the vertical that maps a motion of the hand in the room to one in the assembly's frame,
    // so that a push to the user's right moves the tool to the user's right, also after the user has turned
    // the workpiece.
    Quat heading{1.0, 0.0, 0.0, 0.0};
    const xr::Hands* hands = nullptr;                             // in the room
    std::function<void(xr::Side, const xr::Vibration&)> vibrate;  // may be empty
};

// Input and result of the systems of one frame.
struct LessonFrame {
    ActiveLesson& active;
    const words::Words& words;
    double seconds = 0.0;  // since the previous frame; limited, so that nothing jumps after a long frame
    double overrun = 0.0;  // s by which the frame exceeded that limit
    glm::dvec2 size{1.0};  // px
    FrameInput input;
    const text::Fonts* fonts = nullptr;
    Status status;                    // first error, for example if the session cannot be recorded
    std::optional<RoomInput> room{};  // none: the lesson is shown in a window
};

// Call before the systems. Applies mouse and keys to the hand and the view, based on the world of the
// previous frame.
void handle_input(const scene::SceneWorld& world, LessonFrame& frame);

// Puts the second wrench on the joint that is held or due, or takes it away if it is there. Does nothing for
// a joint that needs none.
void move_second_wrench(ActiveLesson& active);

// The systems of a frame follow, in the order in which they run.

// Steps the ticks that are due; after each of them runs session::tick_systems.
void tick_system(scene::SceneWorld& world, LessonFrame& frame);
// Sets the poses of nuts, wrench and hand from the components.
void placement_system(scene::SceneWorld& world, LessonFrame& frame);
// Updates hints, mistakes, captions, outlines and the arrow of the force.
void guidance_system(scene::SceneWorld& world, LessonFrame& frame);
// Updates the camera, the close-up and the cut-away in front of the nut.
void view_system(scene::SceneWorld& world, LessonFrame& frame);
// Updates the labels at the wrench and at the joints.
void label_system(scene::SceneWorld& world, LessonFrame& frame);
// Collects what the renderer draws into ActiveLesson::scene.
void collect_system(scene::SceneWorld& world, LessonFrame& frame);

inline constexpr ecs::System<scene::SceneWorld, LessonFrame> frame_systems[] = {
    {"ticks", tick_system}, {"placement", placement_system}, {"guidance", guidance_system},
    {"view", view_system},  {"labels", label_system},        {"collect", collect_system}};

// The projection of the scene to pixels from the camera's present viewpoint. `size`: of the picture, px.
Projection projection_of(const ActiveLesson& active, const glm::dvec2& size);

}  // namespace bolt::trainer
