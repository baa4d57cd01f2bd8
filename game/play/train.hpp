// A whole lesson played by a simulated trainee in virtual time, through the same tick and the same input as a
// person.
#pragma once

#include <functional>

#include "game/operators/profile.hpp"
#include "game/operators/view_help.hpp"
#include "game/play/course.hpp"

namespace bolt::play {

struct TrainOptions {
    CourseOptions course;  // operator_name comes from the trainee
    operators::Profile trainee;
    operators::ViewHelp view_help;  // none: the trainee looks by itself
    double longest = 14400.0;       // s of virtual time after which the lesson is given up
    double patience = 900.0;        // s without a step done, likewise
};

struct Progress {
    double time = 0.0;  // s, virtual
    std::size_t step = 0;
    std::size_t steps = 0;
    const lesson::Event* event = nullptr;  // what just happened; null: a second has passed
};

// Writes the session to `file` as it goes. `watch` may return false to stop: the session is then closed as
// it is.
Result<Played> train(const content::Assembly& given, const TrainOptions& options,
                     const std::filesystem::path& file, const std::function<bool(const Progress&)>& watch);

}  // namespace bolt::play
