// Results of joints and lessons as plain data: judged by game/lesson, stored by game/session, shown by
// game/report.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "haptics/joint/stage.hpp"

namespace bolt::lesson {

enum class Verdict : std::uint8_t { none, low, ok, high };

constexpr std::string_view name(Verdict verdict) {
    constexpr std::string_view names[] = {"-", "LOW", "OK", "HIGH"};
    return names[static_cast<int>(verdict)];
}

struct JointResult {
    std::string id;
    double torque = 0.0;  // N·m, highest of the tightening step or of any pull that turned the nut on since
    double angle = 0.0;   // rad from snug
    double clamp =
        0.0;  // N, when the result was last updated (end of lesson: after embedding and cross-talk)
    double clamp_at_release = 0;  // N, when the wrench last left the nut
    Verdict torque_verdict = Verdict::none;
    Verdict angle_verdict = Verdict::none;
    Verdict overall = Verdict::none;  // OK only if all that is judged is OK and the joint is sound
    joint::Condition condition = joint::Condition::sound;
    int strokes = 0;
    int rehits = 0;        // visits to a joint whose step was done already
    int order_errors = 0;  // visits out of turn
};

// The reason for a deduction. A session file stores its text only.
enum class Fault : std::uint8_t {
    none,
    damaged,
    not_ok,
    out_of_turn,
    done_already,
    wrong_way,
    overdone,  // and made good: what still is too much is `not_ok`
    slipped,
    unfinished
};

// A deduction from the score, or a remark without points, with its reason as text.
struct ScoreReason {
    double points = 0.0;
    std::string text;
    Fault fault = Fault::none;
    int joint = -1;  // index, of what is a single joint's fault
    int count = 0;   // how often; unfinished: the step that was due, from 1
    int of = 0;      // unfinished: how many steps there are
};

struct LessonResult {
    double duration = 0.0;  // s
    double score = 0.0;     // 0…100
    bool finished = false;  // every step done
    std::vector<JointResult> joints;
    std::vector<ScoreReason> reasons;
};

// The kind of a mistake, for texts in any language. A session file stores the English text only.
enum class Cause : std::uint8_t {
    none,
    out_of_turn,
    done_already,
    loosened,   // turned back, in a lesson that tightens
    tightened,  // turned on, in one that loosens
    over_torque,
    slipped,
    stripped,
    broken
};

// An event of a lesson, for reports and replay. Kinds: step_begin, step_end, engage, release, stage,
// mistake, pass_begin, back, click, note.
struct Event {
    std::uint64_t tick = 0;
    std::string kind;
    int joint = -1;      // index, −1: none
    double value = 0.0;  // what the kind says: torque at release, stage number …
    std::string text;    // in words
    Cause cause = Cause::none;
};

}  // namespace bolt::lesson
