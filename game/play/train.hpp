// A whole lesson played by a simulated trainee in virtual time, through the same tick and the same input as a
// person.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "engine/base/result.hpp"
#include "game/lesson/lesson.hpp"
#include "game/operators/profile.hpp"

namespace bolt::play {

enum class Obstacles : std::uint8_t { none, if_any, required };

struct TrainOptions {
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    joint::Law law = joint::Law::mechanistic;
    operators::Profile trainee;
    std::uint64_t seed = 1;
    double dt = 0.001;
    // Whether the wrench meets casing, bolts and nuts (touch_models.hpp); `if_any`: where they are modelled.
    Obstacles obstacles = Obstacles::none;
    bool guide = true;         // a guided lesson leads the hand to the nut
    double longest = 14400.0;  // s of virtual time after which the lesson is given up
    double patience = 900.0;   // s without a step done, likewise
};

struct Progress {
    double time = 0.0;  // s, virtual
    std::size_t step = 0;
    std::size_t steps = 0;
    const lesson::Event* event = nullptr;  // what just happened; null: a second has passed
};

// How a lesson came out, and what it was played among.
struct Played {
    lesson::LessonResult result;
    bool obstacles = false;
};

// Writes the session to `file` as it goes. `watch` may return false to stop: the session is then closed as
// it is.
Result<Played> train(const content::Assembly& given, const TrainOptions& options,
                     const std::filesystem::path& file, const std::function<bool(const Progress&)>& watch);

}  // namespace bolt::play
