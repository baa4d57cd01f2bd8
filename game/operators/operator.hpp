// A simulated trainee: sees the assembly, feels the torque late, moves the tool as a hand does and gives way
// to the device's force as a hand does. It drives the lesson through the same input as a person: a device
// pose and a grip, nothing else.
#pragma once

#include <cstdint>
#include <memory>

#include "game/lesson/lesson.hpp"
#include "game/operators/profile.hpp"
#include "game/operators/view_help.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::operators {

struct Mind;  // mind.hpp

class Operator {
  public:
    // `help`: what it asks for a view when it sees too little; none: it has its own head and the first view.
    Operator(const Profile& profile, std::uint64_t seed, const servo::Setup& setup, ViewHelp help = {});
    Operator(Operator&& other) noexcept;
    Operator& operator=(Operator&& other) noexcept;
    ~Operator();

    // The input for the next tick, from what can be seen and felt after the last one. Same seed, same inputs.
    servo::Input act(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson);

    // What it noticed since this was last asked: of kind "sight", how much it sees of the nut that it is
    // being led to or works its way onto, whenever that has changed.
    std::vector<lesson::Event> take_noticed();

  private:
    std::unique_ptr<Mind> mind_;
};

}  // namespace bolt::operators
