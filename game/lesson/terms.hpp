// Text keys for the names of enumeration values.
#pragma once

#include "content/words/words.hpp"
#include "game/lesson/plan.hpp"
#include "game/lesson/result.hpp"
#include "haptics/force/output_stage.hpp"

namespace bolt::lesson {

constexpr words::Key term(lesson::Mode mode) {
    constexpr words::Key keys[] = {"mode.guided", "mode.practice", "mode.assessment"};
    return keys[static_cast<int>(mode)];
}

constexpr words::Key term(lesson::Task task) {
    constexpr words::Key keys[] = {"task.tighten", "task.loosen"};
    return keys[static_cast<int>(task)];
}

constexpr words::Key term(lesson::StepKind kind) {
    constexpr words::Key keys[] = {"step.run_down", "step.tighten", "step.recheck", "step.loosen"};
    return keys[static_cast<int>(kind)];
}

constexpr words::Key term(lesson::Verdict verdict) {
    constexpr words::Key keys[] = {"verdict.none", "verdict.low", "verdict.ok", "verdict.high"};
    return keys[static_cast<int>(verdict)];
}

constexpr words::Key term(joint::Stage stage) {
    constexpr words::Key keys[] = {"stage.navigation", "stage.transition", "stage.linearity", "stage.yield"};
    return keys[static_cast<int>(stage)];
}

constexpr words::Key term(joint::Condition condition) {
    constexpr words::Key keys[] = {"condition.sound", "condition.stripped", "condition.broken"};
    return keys[static_cast<int>(condition)];
}

// Why the device renders no force; shown in assessment too, because it is not a hint.
constexpr words::Key term(force::Fault fault) {
    constexpr words::Key keys[] = {"fault.none",     "fault.silent",      "fault.no_pose", "fault.jumped",
                                   "fault.too_fast", "fault.bad_request", "fault.stopped"};
    static_assert(std::size(keys) == force::fault_kinds);
    return keys[static_cast<int>(fault)];
}

}  // namespace bolt::lesson
