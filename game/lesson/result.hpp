// How a joint and a lesson were done. Plain data: judged by game/lesson, kept by game/record, shown by
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

// A point taken from or given to the score, with its reason in words.
struct ScoreReason {
    double points = 0.0;
    std::string text;
};

struct LessonResult {
    double duration = 0.0;  // s
    double score = 0.0;     // 0…100
    bool finished = false;  // every step done
    std::vector<JointResult> joints;
    std::vector<ScoreReason> reasons;
};

// Something that happened, for reports and replay. Kinds: step_begin, step_end, engage, release, stage,
// mistake, pass_begin, note.
struct Event {
    std::uint64_t tick = 0;
    std::string kind;
    int joint = -1;      // index, −1: none
    double value = 0.0;  // what the kind says: torque at release, stage number …
    std::string text;    // in words
};

}  // namespace bolt::lesson
