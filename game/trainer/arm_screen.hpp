// The screen while a lesson starts, and about an arm that must be prepared: before a lesson, and in a lesson
// in which it was lost.
#pragma once

#include <span>

#include "engine/platform/input.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/screens.hpp"
#include "haptics/device/preparation.hpp"

namespace bolt::trainer {

// s. The question whether the arm may move is shown for this time before a key answers it, because the user
// may press the key that started the lesson twice.
inline constexpr double question_time = 0.5;

// The needs that the screen shows, and for how long it has shown them.
struct ArmScreen {
    device::ArmNeeds needs;
    bool in_lesson = false;  // the arm was lost in a lesson; false: a lesson starts
    bool restores =
        false;  // an interrupted lesson is being restored; that may go on after the devices are open
    double shown_for = 0.0;  // s
};

// Call once a frame. New needs restart the time.
void update(ArmScreen& screen, const device::ArmNeeds& needs, double seconds);

// The action of a key or of the controller. `enter_key_answers`: false while the arrow keys have marked a
// button, which Enter then presses.
ScreenAction action_of(const ArmScreen& screen, std::span<const platform::InputEvent> events,
                       bool enter_key_answers);

ScreenAction draw_arm(const ScreenContext& context, const ArmScreen& screen);

// Pauses the lesson while its arm needs something, and resumes it afterwards, unless the user had paused it.
void pause_for_arm(StationClient& client, LessonClock& clock);

// The text about warm motors; none if they are cool, or if the arm does not report their heat.
std::optional<words::TextKey> arm_warning(const device::DeviceHealth& health);

// One line for the log; empty if the arm needs nothing.
std::string describe(const device::ArmNeeds& needs);

}  // namespace bolt::trainer
