// Classifies what the trainee has to do next, from the lesson, the joints and the hand of one tick. hints.hpp
// selects hints from it over time.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "game/lesson/lesson.hpp"
#include "game/world/world.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::lesson {

enum class Situation : std::uint8_t {
    take_wrench,
    put_wrench_away,  // the step needs the fingers or another tool
    find_by_wrench,   // move the wrench to the due nut
    find_by_fingers,
    set_on,          // put the wrench on the nut
    set_on_again,    // earlier pulls were not enough
    set_on_rounded,  // onto corners that a slipping jaw has rounded off
    counter_hold,    // hold the held part with the second wrench
    grip_nut,
    run_down,
    run_down_by_wrench,
    twist_back,  // the fingers cannot turn further
    seated,      // the nut is run down: let go
    pull,
    pull_to_yield,
    pull_to_click,
    pull_to_click_by_adaptor,  // the wrench is set lower than the torque at the nut
    turn_on,                   // pull until the nut has turned by the step's angle
    set_back,                  // the handle has no room left to swing
    ease,                      // the target is near: pull gently
    ease_to_yield,             // yield is near: pull gently
    ease_to_angle,             // the same for the angle
    stop,                      // the torque is in its window
    stop_at_yield,
    stop_at_click,
    stop_too_much,  // the torque is above its window
    stop_at_angle,
    stop_too_far,  // the angle is above its window
    take_off,      // the pull has ended: take the wrench off the nut
    check,         // re-check: pull until the nut moves or the torque is reached
    checked,
    break_loose,    // loosening: the nut has not moved yet
    unscrew,        // the nut has come loose: turn it until it is free
    turn_back,      // the nut has come loose: turn it back by the step's angle
    turned_back,    // by that angle
    free,           // the nut is loose
    wrong_joint,    // the hand holds a nut that is not due
    other_way_on,   // the nut is being loosened, but the step tightens it
    other_way_off,  // the nut is being tightened, but the step loosens it
    wrench_needed,  // fingers hold a nut that needs the wrench
    leave_broken,   // the due joint is broken: let go
    leave_stripped,
    next,  // the next joint; this and the following six announce a step
    pass_run_down,
    pass_tighten,
    pass_turn,
    pass_recheck,
    pass_turn_back,
    pass_loosen,
    all_done,
};
inline constexpr std::size_t situation_count = 50;

// The lesson after observe(), and the world that it observed in this tick.
struct ObservedLesson {
    const Lesson& lesson;
    const servo::Setup& setup;
    ecs::Access<const world::Joint, const world::ConstrainedTool, const world::WorkingHand,
                const world::ToolState>
        world;
};

// True if the hand has the wrench, also while the wrench is on a nut.
bool wrench_in_hand(const ObservedLesson& work);

enum class HeldItem : std::uint8_t { nothing, wrench, nut_by_fingers, nut_by_wrench };
HeldItem held_item(const ObservedLesson& work);

// The next action that the situation of the lesson requires from the trainee.
Situation situation(const ObservedLesson& work);

// Distance from the tool to the due nut, m; infinite if no step is due.
double distance_to_due(const ObservedLesson& work);

}  // namespace bolt::lesson
