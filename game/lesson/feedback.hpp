// Texts about the lesson: names of enumeration values, the mistake on screen, and the review of the result.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/lesson/lesson.hpp"
#include "game/lesson/result.hpp"
#include "haptics/force/output_stage.hpp"

namespace bolt::lesson {

// Text keys of the names of enumeration values.
constexpr words::TextKey text_key(Mode mode) {
    constexpr words::TextKey keys[] = {"mode.guided", "mode.practice", "mode.assessment"};
    return keys[static_cast<int>(mode)];
}

constexpr words::TextKey text_key(Task task) {
    constexpr words::TextKey keys[] = {"task.tighten", "task.loosen"};
    return keys[static_cast<int>(task)];
}

constexpr words::TextKey text_key(StepKind kind) {
    constexpr words::TextKey keys[] = {"step.run_down", "step.tighten", "step.turn", "step.recheck",
                                       "step.loosen"};
    return keys[static_cast<int>(kind)];
}

constexpr words::TextKey text_key(Verdict verdict) {
    constexpr words::TextKey keys[] = {"verdict.none", "verdict.low", "verdict.ok", "verdict.high"};
    return keys[static_cast<int>(verdict)];
}

constexpr words::TextKey text_key(joint::Stage stage) {
    constexpr words::TextKey keys[] = {"stage.navigation", "stage.transition", "stage.linearity",
                                       "stage.yield"};
    return keys[static_cast<int>(stage)];
}

constexpr words::TextKey text_key(joint::JointCondition condition) {
    constexpr words::TextKey keys[] = {"condition.intact", "condition.stripped", "condition.broken"};
    return keys[static_cast<int>(condition)];
}

// The reason why the device renders no force. It is shown in assessment too, because it is not a hint.
constexpr words::TextKey text_key(force::Fault fault) {
    constexpr words::TextKey keys[] = {"fault.none",     "fault.silent",      "fault.no_pose", "fault.jumped",
                                       "fault.too_fast", "fault.bad_request", "fault.stopped"};
    static_assert(std::size(keys) == force::fault_kinds);
    return keys[static_cast<int>(fault)];
}

// A mistake and its remedy as text keys.
struct Mistake {
    MistakeKind kind = MistakeKind::none;  // kinds are ordered by severity, the worst last
    int joint = -1;                        // the joint that it concerns
    words::TextKey text = "mistake.out_of_turn";
    words::TextKey remedy = "mistake.out_of_turn.do";
    std::vector<words::TextArgument> arguments;
};

// The mistake of this event, in the state of the lesson right after it. None: the event is no mistake, or its
// text names the due joint and no joint is due.
std::optional<Mistake> mistake_of(const Lesson& lesson, const LessonEvent& event);

// The mistake on screen, which stays there for mistake_duration. An assessment shows no mistakes.
struct MistakeState {
    std::optional<Mistake> shown;
    std::optional<Mistake> waiting;  // at least as severe as `shown`; replaces it after min_mistake_duration
    double shown_for = 0.0;          // s
};

inline constexpr double mistake_duration = 6.0;      // s
inline constexpr double min_mistake_duration = 1.5;  // s, before another mistake may replace it

// Call with each event of the lesson; only mistakes and undone steps have an effect. Undoing a step hides its
// mistake.
void add_event(MistakeState& mistakes, const Lesson& lesson, const LessonEvent& event);

// Advances by `dt` seconds and returns the mistake to show.
const std::optional<Mistake>& update(MistakeState& mistakes, double dt);

std::string mistake_text(const words::Words& words, const Mistake& mistake);
std::string remedy_text(const words::Words& words, const Mistake& mistake);

// The text of a Deduction, in the language of the trainee.
struct DeductionText {
    double points = 0.0;  // added to the score; negative for a deduction
    std::optional<words::TextKey> key;
    std::vector<words::TextArgument> arguments;
    std::string text;  // used without `key`: a session read from a file stores only the text
};

// The result of a lesson explained: why points were deducted and what to do better next time.
struct Review {
    std::vector<DeductionText> reasons;          // in the order of LessonResult::reasons
    std::vector<words::TextKey> advice;          // up to three, the costliest first
    std::vector<words::TextArgument> arguments;  // of the advice
};

// `assembly`: of the lesson, with its law applied (apply_law); it gives the torque and angle windows.
Review review(const content::Assembly& assembly, const LessonResult& result);

std::string deduction_text(const words::Words& words, const DeductionText& deduction);

}  // namespace bolt::lesson
