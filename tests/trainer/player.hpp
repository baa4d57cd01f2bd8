// A simulated trainee at the mouse who completes the due steps: presses, drags, watches the torque, releases.
#pragma once

#include "game/session/lesson_session.hpp"
#include "game/trainer/helped_hand.hpp"

namespace trainer_test {

using namespace bolt;

struct Player {
    trainer::HelpedHand hand;
    bool button_down = false;
    double wait_left = 0.0;  // s that remain until the next press
    double peak = 0.0;       // N·m, largest torque of this step
    std::size_t step = SIZE_MAX;
    int presses = 0;
};

// The trainee's input for a frame of `seconds`.
trainer::MouseCommand next_command(Player& player, const session::LessonSession& session, double seconds);

content::Assembly assembly(const char* name);

}  // namespace trainer_test
