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
    put_wrench_away,
    find_by_wrench,
    find_by_fingers,
    set_on,
    set_on_again,    // earlier pulls were not enough
    set_on_rounded,  // onto corners that a slipping jaw has rounded off
    counter_hold,    // hold the held part with the second wrench
    grip_nut,
    run_down,
    run_down_by_wrench,
    twist_back,  // the fingers cannot turn further
    seated,
    pull,
    pull_to_yield,
    pull_to_click,
    pull_to_click_by_adaptor,  // the wrench is set lower than the torque at the nut
    turn_on,                   // pull until the nut has turned by the step's angle
    set_back,                  // the handle has no room left to swing
    ease,                      // the target is near: pull gently
    ease_to_yield,             // yield is near: pull gently
    ease_to_angle,             // the same for the angle
    stop,
    stop_at_yield,
    stop_at_click,
    stop_too_much,
    stop_at_angle,
    stop_too_far,
    take_off,
    check,  // re-check: pull until the nut moves or the torque is reached
    checked,
    break_loose,
    unscrew,
    turn_back,    // it has come loose: turn it back by the step's angle
    turned_back,  // by that angle
    free,         // the nut is loose
    wrong_joint,
    other_way_on,
    other_way_off,
    wrench_needed,  // fingers hold a nut that needs the wrench
    leave_broken,
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

// Also true while the wrench is on a nut.
bool wrench_in_hand(const ObservedLesson& work);

enum class HeldItem : std::uint8_t { nothing, wrench, nut_by_fingers, nut_by_wrench };
HeldItem held_item(const ObservedLesson& work);

Situation situation(const ObservedLesson& work);

// Distance from the tool to the due nut, m; infinite if no step is due.
double distance_to_due(const ObservedLesson& work);

}  // namespace bolt::lesson
