// Somebody at a mouse who does what is due: presses, drags, watches the torque, lets go.
#pragma once

#include "game/session/lesson_session.hpp"
#include "game/trainer/mouse_hand.hpp"

namespace trainer_test {

using namespace bolt;

struct Player {
    trainer::MouseHand hand;
    bool held = false;
    double waited = 0.0;  // s until the next press
    double peak = 0.0;    // N·m of this step
    std::size_t step = SIZE_MAX;
    int presses = 0;
};

// What it wishes in a frame of that length.
trainer::Wish wish_of(Player& player, const session::Course& course, double seconds);

content::Assembly assembly(const char* name);

}  // namespace trainer_test
