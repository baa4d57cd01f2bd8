// A simulated trainee, and train(), which runs a whole lesson with it in virtual time. The trainee sees the
// assembly, feels the torque with a delay, moves the tool and gives way to the device's force like a hand.
// Its input to the servo tick is that of a person: a device pose and a grip.
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

struct TraineeState;  // behaviour.hpp

// The pose that a trainee wants the tool to have, and its grip.
struct IntendedPose {
    Pose tool;  // in the assembly's frame
    servo::Grip grip = servo::Grip::none;
    std::int16_t guided_joint = -1;   // joint that the guiding force leads to; −1: none
    std::uint8_t tool_index = 0;      // tool that the hand takes next (servo::TickInput::tool)
    std::int16_t second_wrench = -1;  // joint whose held part the second wrench is on; −1: none
    bool holds_nut = false;           // the hand turns a nut, or waits on it, and does not give way to forces
};

class SimulatedTrainee {
  public:
    // `help` provides a view when the trainee sees too little. Without it the trainee only moves its head.
    SimulatedTrainee(const TraineeProfile& profile, std::uint64_t seed, const servo::Setup& setup,
                     motion::ViewHelper help = {});
    SimulatedTrainee(SimulatedTrainee&& other) noexcept;
    SimulatedTrainee& operator=(SimulatedTrainee&& other) noexcept;
    ~SimulatedTrainee();

    // Returns the input for the next tick from the percepts after the last one. Deterministic in the seed.
    servo::TickInput act(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson);

    // As act(), for a trainee that holds a force-feedback arm: returns the intended pose; the arm determines
    // how far the hand follows it. `hand`: the pose of the tool that the arm commands now.
    IntendedPose intend(const servo::Setup& setup, const servo::State& state, const lesson::Lesson& lesson,
                        const Pose& hand);

    // The pose of the tool that the hand commands; before the first tick, its initial pose.
    [[nodiscard]] const Pose& hand() const;

    // Returns and clears the events since the last call. They are of kind `visibility`: while the trainee
    // aligns the wrench with the due nut, one for each noticeable change of the nut's visible fraction.
    std::vector<lesson::LessonEvent> take_events();

  private:
    std::unique_ptr<TraineeState> state_;
};

struct TrainOptions {
    session::LessonOptions lesson;  // train() sets trainee_profile and view_help
    TraineeProfile trainee;
    motion::ViewHelper view_help;  // none: the trainee only moves its head
    double time_limit = 14400.0;   // s of virtual time after which the lesson is aborted
    // s of virtual time. The lesson is also aborted if for so long no new step begins and the due nut turns
    // no further.
    double patience = 900.0;
};

struct TrainingProgress {
    double time = 0.0;      // s, virtual time
    std::size_t step = 0;   // index of the due step
    std::size_t steps = 0;  // number of steps
    const lesson::LessonEvent* event =
        nullptr;  // that is reported; null in the periodic report, once a virtual second
};

// Runs a lesson to its end with a simulated trainee and records the session to `file` meanwhile. If `watch`
// returns false the lesson stops, and the session is closed as unfinished.
Result<session::LessonOutcome> train(const content::Assembly& assembly, const TrainOptions& options,
                                     const std::filesystem::path& file,
                                     const std::function<bool(const TrainingProgress&)>& watch);

}  // namespace bolt::trainees
