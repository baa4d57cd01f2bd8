// The situation of the trainee, from the lesson, the joints and the hand of one tick. hints.hpp adds time.
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
    set_on_again,    // the pulls before were not enough
    set_on_rounded,  // on corners that a slipping jaw has worn
    grip_nut,
    run_down,
    run_down_by_wrench,
    twist_back,  // the fingers have no more way
    seated,
    pull,
    pull_to_yield,
    pull_to_click,
    set_back,  // the handle has no more room
    ease,
    ease_to_yield,
    stop,
    stop_at_yield,
    stop_at_click,
    stop_too_much,
    take_off,
    check,
    checked,
    break_loose,
    turn_off,
    free,
    wrong_joint,
    other_way_on,
    other_way_off,
    wrench_needed,  // fingers hold what they cannot do
    leave_broken,
    leave_stripped,
    next,  // these five are said when a step begins
    round_run_down,
    round_tighten,
    round_recheck,
    round_loosen,
    all_done,
};
inline constexpr std::size_t situation_count = 40;

// The work after a tick: the lesson that has observed it, and the world as haptic_system has written it.
struct Scene {
    const lesson::Lesson& lesson;
    const servo::Setup& setup;
    ecs::Access<const world::Joint, const world::Tool, const world::Hand> world;
};

bool wrench_in_hand(const Scene& scene);  // also while it is on no nut

enum class Held : std::uint8_t { nothing, wrench, nut_by_fingers, nut_by_wrench };
Held held(const Scene& scene);

Situation situation(const Scene& scene);

// Distance from the tool to the due nut, m; infinite if no nut is due.
double distance_to_due(const Scene& scene);

}  // namespace bolt::lesson
