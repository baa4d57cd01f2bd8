// What a simulated trainee intends to do about a step of the lesson, right or wrong.
#pragma once

#include <cstdint>

#include "engine/base/random.hpp"
#include "game/lesson/lesson.hpp"
#include "game/trainees/profile.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::trainees {

struct Intent {
    std::size_t step = SIZE_MAX;  // of the lesson
    std::size_t joint = 0;        // that it believes is due
    bool fingers = false;         // the nut is run down by hand
    bool loosening = false;
    bool wrong = false;           // it went to a wrong joint
    bool until_seated = false;    // it runs the nut down until it sits
    bool checks = false;          // it only wants to see the nut begin to move
    bool stops_at_yield = false;  // it means to stop where the resistance stops growing
    bool until_click = false;     // it means to stop when its torque wrench clicks
    double goal = 0.0;            // N·m at which it means to stop
    double least = 0.0;           // N·m below which it knows that it is not done
    int tries = 0;                // at this step before
    bool finished = false;        // as far as it can tell
};

// The step to work on; null: none is left. In assessment nobody says that a joint is not tight enough: who
// believes to be done goes on.
const lesson::Step* next_step(const lesson::Lesson& lesson, const Intent& intent);

// How this person goes about a step. `before`: what it meant to do last.
Intent intend(const Profile& profile, Random& random, const servo::Setup& setup, const lesson::Lesson& lesson,
              const lesson::Step& due, const Intent& before);

}  // namespace bolt::trainees
