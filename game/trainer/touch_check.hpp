// The touch that checks, at the start of a lesson, whether the arm still is where its registration says: the
// user holds the tip of the arm on the registration's check point, a mark in the real room, where a marker is
// drawn. The lesson is paused meanwhile, so the arm renders no force.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "content/station/registration.hpp"
#include "engine/platform/input.hpp"
#include "engine/render/scene.hpp"
#include "game/scene/workplace.hpp"
#include "game/trainer/screens.hpp"
#include "haptics/station/station_tick.hpp"

namespace bolt::trainer {

enum class TouchPhase : std::uint8_t {
    waiting,    // until a button of the arm, or Enter, is pressed
    measuring,  // the positions of the tip are collected
    passed,     // the result, until the user starts the lesson
    failed,     // off by more than station_setup::max_check_error
};

struct TouchCheck {
    Vec3 marker{0.0};  // m, the check point in the room
    Pose arm_in_room;  // the registration
    Vec3 tip{0.0};     // m, in the frame of the arm's handle

    TouchPhase phase = TouchPhase::waiting;
    bool failed_touch = false;         // the last touch: the hand moved, or the arm was lost
    double error = 0.0;                // m, of the result
    double shown_for = 0.0;            // s for which the phase is shown
    std::vector<Vec3> touched;         // m, positions of the tip in the room
    std::uint32_t held_buttons = ~0U;  // of the arm, already held; only another one counts as a press
};

// True until there is a result.
inline bool waits_for_touch(const TouchCheck& check) {
    return check.phase == TouchPhase::waiting || check.phase == TouchPhase::measuring;
}

// None if the registration is not between arm and room, in either direction, or has no check point.
std::optional<TouchCheck> touch_check_of(const content::Registration& registration);

// Call once a frame. `mover`: StationTick::mover; while there is none, nothing is measured. `confirmed`: the
// user has pressed Enter. Returns true when the user starts the lesson.
bool update(TouchCheck& check, const std::optional<station::MoverSample>& mover, bool confirmed,
            double seconds);

// The user's answer in a frame: Enter, which confirms, or Escape, which ends the check.
struct TouchAnswer {
    bool confirmed = false, ended = false;
};
// `enter_key_answers`: false while the arrow keys have marked a button, which Enter then presses.
TouchAnswer answer_of(const TouchCheck& check, std::span<const platform::InputEvent> events,
                      bool enter_key_answers);

ScreenAction draw_touch_check(const ScreenContext& context, const TouchCheck& check);

// The pose of the assembly's frame in the room while the check waits for a touch. `workpiece`: the pose of
// the workpiece in the room, which is the result if it is `registered`. Otherwise the result places the
// clamping plate 20 mm below the marker, and the caller hides the workpiece. The result does not depend on
// the arm.
Pose touch_scene(const TouchCheck& check, const Pose& workpiece, bool registered,
                 const render::BoundingBox& box);

// m from the marker at which the drawn tip of the arm disappears. Tip and marker are drawn from the same
// registration, so they meet even if it is wrong. The touch needs the real tip and the real mark.
inline constexpr double hidden_tip_distance = 0.04;

// The objects that are shown, besides the workshop, while the check waits for a touch.
struct TouchView {
    const words::Words& words;
    Pose scene_in_room;
    std::optional<Pose> handle;  // of the arm, in the arm's frame; none: no sample
    bool shows_workpiece = false;
};
// Shows arrows whose points meet at the marker, and an arrow whose point is the tip of the arm. Hides hand
// and tools, because the drawn hand follows the arm.
void show_touch_marker(render::Scene& scene, const scene::GpuLessonModels& models, const TouchCheck& check,
                       const TouchView& view);

}  // namespace bolt::trainer
