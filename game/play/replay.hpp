// A session played again: the same inputs through the same servo, and every tick held against what was
// recorded.
#pragma once

#include <functional>

#include "game/play/course.hpp"

namespace bolt::play {

// What a recorded lesson began with: its assembly's text as it was recorded, the models that lie there now.
// An error: the session does not say enough (format 1), a model is not there, or is not the one that was met.
Result<Prepared> prepare_again(const record::Reader& session);

struct Moment {
    const servo::Setup& setup;
    const servo::State& state;
    const lesson::Lesson& lesson;  // with the events of this tick
    const servo::Input& input;
    const servo::Output& output;
    double time = 0.0;  // s, after the tick
};

struct Replayed {
    std::uint64_t ticks = 0;
    std::uint64_t wrong = 0;  // ticks that did not come out as they were recorded
    std::uint64_t first_wrong = 0;
};

// Every tick in turn; `visit` returns whether to go on. From `at` on, which is used up.
Result<Replayed> replay(const record::Reader& session, Prepared at,
                        const std::function<bool(const Moment&)>& visit);

}  // namespace bolt::play
