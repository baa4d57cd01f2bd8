// A simulated trainee: sees the assembly, feels the torque with a delay, moves the tool as a hand does and
// yields to the device's force as a hand does. It drives the lesson through the same input as a person: a
// device pose and a grip.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "game/lesson/lesson.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/human_model.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::trainees {

struct Mind;  // mind.hpp

class Operator {
  public:
    // `help`: provides a view when the trainee sees too little; none: it starts from the first view and moves
    // its head.
    Operator(const Profile& profile, std::uint64_t seed, const servo::Setup& setup,
             motion::ViewHelp help = {});
    Operator(Operator&& other) noexcept;
    Operator& operator=(Operator&& other) noexcept;
    ~Operator();

    // The input for the next tick, from what can be seen and felt after the last one. Same seed, same inputs.
    servo::Input act(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson);

    // Returns and clears what it noticed since the last call: events of kind "sight" with the visible
    // fraction of the due nut, one for each change.
    std::vector<lesson::Event> take_noticed();

  private:
    std::unique_ptr<Mind> mind_;
};

// A whole lesson played by a simulated trainee in virtual time, through the same tick and the same input as a
// person.

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
