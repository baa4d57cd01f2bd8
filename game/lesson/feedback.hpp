// Text keys for the names of enumeration values.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/lesson/lesson.hpp"
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

// Shows a mistake for some seconds, with its reason and its remedy. In assessment none is shown.

struct Mistake {
    lesson::Cause cause = lesson::Cause::none;  // in the order of their gravity
    int joint = -1;                             // of which it is said
    words::Key why = "mistake.out_of_turn";
    words::Key what_to_do = "mistake.out_of_turn.do";
    std::vector<words::Place> places;
};

struct Mistakes {
    std::optional<Mistake> shown;
    std::optional<Mistake> waiting;  // as grave or graver: shown when the other could be read
    double stands = 0.0;             // s that `shown` has been
};

inline constexpr double mistake_stands = 6.0;    // s
inline constexpr double shortest_mistake = 1.5;  // s, before a graver one takes its place

// Takes each event of the lesson; only mistakes and undone steps have an effect. Undoing a step hides its
// mistake.
void note(Mistakes& mistakes, const lesson::Lesson& lesson, const lesson::Event& event);

const std::optional<Mistake>& update(Mistakes& mistakes, double dt);

std::string say_why(const words::Words& words, const Mistake& mistake);
std::string say_what_to_do(const words::Words& words, const Mistake& mistake);

// Explains the result of a lesson: why points were deducted and what to do better next time.

struct Remark {
    double points = 0.0;  // as in the score: negative where they were taken
    std::optional<words::Key> key;
    std::vector<words::Place> places;
    std::string text;  // of a session that was read again: it has no more than that
};

struct Review {
    std::vector<Remark> reasons;     // in the order of the score's
    std::vector<words::Key> advice;  // one to three; what cost most first
};

// `assembly`: that of the lesson, under its law (under_law), for the torque and angle windows.
Review review(const content::Assembly& assembly, const lesson::LessonResult& result);

std::string say(const words::Words& words, const Remark& remark);

}  // namespace bolt::lesson
