// A whole lesson played by a simulated trainee in virtual time, through the same tick and the same input as a
// person.
#pragma once

#include <functional>

#include "game/motion/view_help.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/profile.hpp"

namespace bolt::trainees {

struct TrainOptions {
    session::CourseOptions course;  // operator_name comes from the trainee
    trainees::Profile trainee;
    motion::ViewHelp view_help;  // none: the trainee looks by itself
    double longest = 14400.0;    // s of virtual time after which the lesson is given up
    double patience = 900.0;     // s without a step done, likewise
};

struct Progress {
    double time = 0.0;  // s, virtual
    std::size_t step = 0;
    std::size_t steps = 0;
    const lesson::Event* event = nullptr;  // what just happened; null: a second has passed
};

// Writes the session to `file` as it goes. `watch` may return false to stop: the session is then closed as
// it is.
Result<session::Played> train(const content::Assembly& given, const TrainOptions& options,
                              const std::filesystem::path& file,
                              const std::function<bool(const Progress&)>& watch);

}  // namespace bolt::trainees
