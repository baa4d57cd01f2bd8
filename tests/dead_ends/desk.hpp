// A lesson as a frame of the trainer has it, and a frame of the device's ticks: every tick is watched.
#pragma once

#include <optional>

#include "game/trainer/going_back.hpp"
#include "tests/dead_ends/watch.hpp"
#include "tests/trainer/player.hpp"

namespace dead_ends {

inline constexpr int frame_ticks = 16;
inline constexpr double frame_seconds = 0.016;

struct Desk {
    play::Course& course;
    Watch& watch;
    servo::Output output;
    servo::Input last;
    trainer_test::Player player;
    trainer::GoingBack back;
    double sets = 1.0;  // a torque wrench to this share of what is right

    Desk(play::Course& c, Watch& w);

    // As the trainer has it: a mistake in the last step is still to be taken back.
    [[nodiscard]] bool over() const { return !trainer::goes_on(back, course); }
    // One tick; false where nothing can go on.
    bool tick(servo::Input input, bool wrench_in_hand, double room, bool asks = false);
    // A frame at the mouse: wishes and undos as the trainer's systems treat them.
    void frame(trainer::Wish wish, std::optional<std::size_t> takes_back = std::nullopt, bool asks = false);
    [[nodiscard]] bool stuck() const { return !watch.troubles().empty(); }
};

// Somebody who does anything, for that long.
void meddle_at_mouse(Desk& desk, std::uint64_t seed, double span, bool rough);
void meddle_at_device(Desk& desk, std::uint64_t seed, double span, bool rough);

// Somebody who knows how it is done, and not when it is enough.
void overdo_at_mouse(Desk& desk, std::uint64_t seed, double span);
void overdo_at_device(Desk& desk, std::uint64_t seed, double span);

// Somebody competent from here to the end. How often a step was begun anew or taken back; a dead end is a
// trouble.
int finish_at_mouse(Desk& desk);
int finish_at_device(Desk& desk, std::uint64_t seed);

}  // namespace dead_ends
