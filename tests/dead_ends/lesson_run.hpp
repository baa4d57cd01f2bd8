// A lesson at the mouse or at a device, stepped like in the trainer. An InvariantChecker checks every tick.
#pragma once

#include <optional>

#include "game/trainer/step_undo.hpp"
#include "tests/dead_ends/invariant_checker.hpp"
#include "tests/trainer/player.hpp"

namespace dead_ends {

inline constexpr int frame_ticks = 16;
inline constexpr double frame_seconds = 0.016;

struct LessonRun {
    session::LessonSession& session;
    InvariantChecker& checker;
    world::World world;
    servo::Output output;
    servo::TickInput last;
    trainer_test::Player player;
    trainer::StepUndo undo;
    double set_torque_scale = 1.0;  // set torque of a torque wrench, relative to the correct one

    LessonRun(session::LessonSession& lesson_session, InvariantChecker& invariant_checker);

    // As in the trainer: false while a mistake in the last step can still be undone.
    [[nodiscard]] bool over() const { return !trainer::continues(undo, session); }
    // One tick; returns false if the session cannot continue.
    bool tick(servo::TickInput input, bool wrench_in_hand, double free_swing, bool hint_key = false);
    // A frame at the mouse: handles commands and undo like the trainer's systems.
    void frame(trainer::MouseCommand command, std::optional<std::size_t> undo_steps = std::nullopt,
               bool hint_key = false);
    [[nodiscard]] bool failed() const { return !checker.problems().empty(); }
};

// A trainee with random actions for `span` seconds.
void act_randomly_at_mouse(LessonRun& run, std::uint64_t seed, double span, bool rough);
void act_randomly_at_device(LessonRun& run, std::uint64_t seed, double span, bool rough);

// A trainee who uses the tools correctly, but tightens too far.
void overtighten_at_mouse(LessonRun& run, std::uint64_t seed, double span);
void overtighten_at_device(LessonRun& run, std::uint64_t seed, double span);

// A competent trainee finishes the lesson. Returns how many steps were restarted or undone; a dead end is
// reported to the checker.
int finish_at_mouse(LessonRun& run);
int finish_at_device(LessonRun& run, std::uint64_t seed);

}  // namespace dead_ends
