// A simulated trainee: sees the assembly, feels the torque with a delay, moves the tool as a hand does and
// yields to the device's force as a hand does. It drives the lesson through the same input as a person: a
// device pose and a grip.
#pragma once

#include <cstdint>
#include <memory>

#include "game/lesson/lesson.hpp"
#include "game/motion/view_help.hpp"
#include "game/trainees/profile.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::trainees {

struct Mind;  // mind.hpp

class Operator {
  public:
    // `help`: provides a view when the trainee sees too little; none: it starts from the first view and moves
    // its head.
    Operator(const Profile& profile, std::uint64_t seed, const servo::Setup& setup,
             motion::ViewHelp help = {});
    Operator(Operator&& other) noexcept;
    Operator& operator=(Operator&& other) noexcept;
    ~Operator();

    // The input for the next tick, from what can be seen and felt after the last one. Same seed, same inputs.
    servo::Input act(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson);

    // Returns and clears what it noticed since the last call: events of kind "sight" with the visible
    // fraction of the due nut, one for each change.
    std::vector<lesson::Event> take_noticed();

  private:
    std::unique_ptr<Mind> mind_;
};

}  // namespace bolt::trainees
