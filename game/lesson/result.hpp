// Modes, tasks and results of lessons as plain data: used by game/lesson, stored by game/session, shown by
// game/report.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/enum_names.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::lesson {

enum class Mode : std::uint8_t { guided, practice, assessment };
enum class Task : std::uint8_t { tighten, loosen };

inline constexpr EnumNames<Mode, 3> mode_names{{"guided", "practice", "assessment"}};
constexpr std::string_view name(Mode mode) { return mode_names.of(mode); }

inline constexpr EnumNames<Task, 2> task_names{{"tighten", "loosen"}};
constexpr std::string_view name(Task task) { return task_names.of(task); }

enum class Verdict : std::uint8_t { none, low, ok, high };

inline constexpr EnumNames<Verdict, 4> verdict_names{{"-", "LOW", "OK", "HIGH"}};
constexpr std::string_view name(Verdict verdict) { return verdict_names.of(verdict); }

struct JointResult {
    std::string id;
    // N·m, highest torque in the tightening step and in later pulls that tightened further. In a loosening
    // lesson: the highest in the joint's loosening steps.
    double torque = 0.0;
    double angle = 0.0;  // rad, of the nut from its mark; loosening: by which its steps turned it back
    // N, when the result was last updated; at the end of the lesson it includes embedding and the interaction
    // of the joints
    double clamp = 0.0;
    double clamp_at_release = 0;  // N, when the hand last left the nut
    Verdict torque_verdict = Verdict::none;
    Verdict angle_verdict = Verdict::none;
    Verdict overall = Verdict::none;  // OK only if each judged quantity is OK and the joint is sound
    joint::JointCondition condition = joint::JointCondition::intact;
    int strokes = 0;       // holds in which the wrench loaded or turned the nut
    int done_already = 0;  // times that the hand worked on it after its step was done
    int out_of_turn = 0;   // times that the hand worked on it before its step was due
};

// The reason for a deduction. A session file stores its text only.
enum class DeductionKind : std::uint8_t {
    none,
    damaged,
    not_ok,
    out_of_turn,
    done_already,
    wrong_way,
    over_torque,  // excess torque that was corrected since; if it remains, the reason is `not_ok`
    over_turned,  // an excess angle that was corrected since
    slipped,
    turned_together,
    weak_tool,
    torque_wrench_loosens,
    tool_bent,
    unfinished
};

// A deduction from the score with its reason as text. A deduction of 0 points only explains.
struct Deduction {
    double points = 0.0;  // added to the score, so negative
    std::string text;
    DeductionKind kind = DeductionKind::none;
    int joint = -1;      // index, if it concerns one joint; −1: several or none
    int count = 0;       // number of occurrences; unfinished: the due step, counted from 1
    int step_count = 0;  // unfinished: number of all steps
};

struct LessonResult {
    double duration = 0.0;  // s
    double score = 0.0;     // 0…100
    bool finished = false;  // every step is done
    std::vector<JointResult> joints;
    std::vector<Deduction> reasons;
};

// The kind of a mistake, in order of severity. lesson.cpp detects mistakes; feedback.cpp has their texts. A
// session file stores the English text only.
enum class MistakeKind : std::uint8_t {
    none,
    out_of_turn,
    done_already,
    loosened,   // in a tightening lesson
    tightened,  // in a loosening lesson
    over_torque,
    over_turned,            // turned further than its angle window
    turned_together,        // nut and bolt turned together: nothing held the other part
    weak_tool,              // the chosen tool is too weak (tool_choice.hpp)
    torque_wrench_loosens,  // a torque wrench was chosen for loosening
    tool_bent,
    slipped,
    stripped,
    broken
};
inline constexpr std::size_t mistake_kinds =
    static_cast<std::size_t>(MistakeKind::broken) + 1;  // the last kind

// Behind each kind: the meaning of its LessonEvent::value.
enum class EventKind : std::uint8_t {
    pass_begin,  // number of the pass, from 0
    step_begin,  // target torque, N·m
    step_end,    // peak torque, N·m
    engage,      // unused: 0
    release,     // peak torque of the step, N·m
    stage,       // joint::Stage
    click,       // torque at the click, N·m
    mistake,     // a value that each MistakeKind defines by its report in lesson.cpp
    undo,        // number of steps undone
    visibility,  // visible fraction of the due nut, 0 … 1
    note
};

// The names in session files. `undo` and `visibility` have older names there.
inline constexpr EnumNames<EventKind, 11> event_kind_names{{"pass_begin", "step_begin", "step_end", "engage",
                                                            "release", "stage", "click", "mistake", "back",
                                                            "sight", "note"}};
constexpr std::string_view name(EventKind kind) { return event_kind_names.of(kind); }
// None if no kind has this name.
constexpr std::optional<EventKind> event_kind(std::string_view text) { return event_kind_names.find(text); }

// An event of a lesson, for reports and replay.
struct LessonEvent {
    std::uint64_t tick = 0;
    EventKind kind = EventKind::note;
    int joint = -1;      // index, −1: none
    double value = 0.0;  // see EventKind
    std::string text;    // English description
    MistakeKind mistake = MistakeKind::none;
};

}  // namespace bolt::lesson
