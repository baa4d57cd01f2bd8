// A lesson at the mouse or at a device, stepped as the trainer steps it; a Watch checks every tick.
#pragma once

#include <optional>

#include "game/trainer/step_undo.hpp"
#include "tests/dead_ends/watch.hpp"
#include "tests/trainer/player.hpp"

namespace dead_ends {

inline constexpr int frame_ticks = 16;
inline constexpr double frame_seconds = 0.016;

struct Desk {
    session::Course& course;
    Watch& watch;
    servo::Output output;
    servo::Input last;
    trainer_test::Player player;
    trainer::StepUndo back;
    double sets = 1.0;  // the setting of a torque wrench, as a share of the right one

    Desk(session::Course& c, Watch& w);

    // As in the trainer: false while a mistake in the last step is still to be undone.
    [[nodiscard]] bool over() const { return !trainer::goes_on(back, course); }
    // One tick; returns false if the session cannot continue.
    bool tick(servo::Input input, bool wrench_in_hand, double room, bool asks = false);
    // A frame at the mouse: handles wishes and undos as the trainer's systems do.
    void frame(trainer::Wish wish, std::optional<std::size_t> takes_back = std::nullopt, bool asks = false);
    [[nodiscard]] bool stuck() const { return !watch.troubles().empty(); }
};

// A trainee who does random things for `span` seconds.
void meddle_at_mouse(Desk& desk, std::uint64_t seed, double span, bool rough);
void meddle_at_device(Desk& desk, std::uint64_t seed, double span, bool rough);

// A trainee who uses the tools correctly, but tightens too far.
void overdo_at_mouse(Desk& desk, std::uint64_t seed, double span);
void overdo_at_device(Desk& desk, std::uint64_t seed, double span);

// A competent trainee finishes the lesson. Returns how many steps were restarted or undone; a dead end is
// recorded as trouble.
int finish_at_mouse(Desk& desk);
int finish_at_device(Desk& desk, std::uint64_t seed);

}  // namespace dead_ends
