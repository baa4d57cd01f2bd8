// Plays ticks and frames through the vibration of a hand controller.
#pragma once

#include <doctest/doctest.h>

#include <vector>

#include "haptics/servo/vibration.hpp"

namespace bolt::test {

struct SentCommand {
    double time = 0.0;  // s
    servo::VibrationInput input;
    servo::VibrationCommand command;
};

// Runs ticks of 1 ms, and a frame every `frame` ticks.
struct VibrationPlayer {
    servo::VibrationOptions options{};
    int frame = 11;
    servo::VibrationState state{};
    servo::VibrationInput input{};
    std::vector<SentCommand> sent{};
    int ticks = 0;

    static constexpr double dt = 1e-3;

    void tick() {
        servo::advance_vibration(state, options, input, dt);
        // Events are true for one tick.
        input.slipped = input.clicked = false;
        input.strike_speed = 0.0;
        if (++ticks % frame != 0) return;
        if (const auto command = servo::next_vibration(state, options))
            sent.push_back({state.time, input, *command});
    }
    void run(int count) {
        for (int i = 0; i < count; ++i) tick();
    }
    // Turns the nut evenly by `angle` rad while the torque changes evenly to `torque`.
    void turn(double angle, double torque, int count) {
        const double step = angle / count, load = (torque - input.torque) / count;
        for (int i = 0; i < count; ++i) {
            input.angle += step;
            input.torque += load;
            tick();
        }
    }
    [[nodiscard]] int count(servo::VibrationCue cue) const {
        int found = 0;
        for (const SentCommand& one : sent) found += one.command.cue == cue ? 1 : 0;
        return found;
    }
};

inline bool is_valid(const servo::VibrationCommand& command) {
    return command.amplitude > 0.0 && command.amplitude <= 1.0 && command.frequency >= 20.0 &&
           command.frequency <= 500.0 && command.duration > 0.0 && command.duration <= 0.5;
}

}  // namespace bolt::test
