// The plan of a simulated trainee for one step of a lesson: the tool, the torque or angle at which it stops,
// and the mistakes that it will make.
#pragma once

#include <cstddef>
#include <cstdint>

#include "engine/base/random.hpp"
#include "game/lesson/lesson.hpp"
#include "game/trainees/human_model.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::trainees {

// The trainee's plan for one step of the lesson, correct or not.
struct StepPlan {
    std::size_t step = SIZE_MAX;  // index into Lesson::steps
    std::size_t joint = 0;        // the joint that the trainee believes to be due
    bool fingers = false;         // runs the nut down by hand
    bool loosening = false;
    bool wrong_joint = false;   // `joint` is not the due one
    bool until_seated = false;  // runs the nut down; a wrench then stops a little above the nut's drag
    bool only_checks = false;   // re-check: stops as soon as the nut begins to move
    bool until_yield = false;   // stops when the bolt begins to yield
    bool until_click = false;   // stops at the click of the torque wrench
    double goal_torque = 0.0;   // N·m at which it stops
    // rad, rotation of the nut at which the trainee stops, whatever the torque: from the mark; when
    // loosening, turned back from the start of the step. 0: the torque decides.
    double goal_angle = 0.0;
    double min_torque = 0.0;  // N·m, known lower limit: below it, yielding does not stop the pull
    bool forgets_second_wrench = false;
    int attempt = 0;        // number of earlier attempts at this step
    bool finished = false;  // the trainee believes that the step is done
};

// Returns the step to work on, or null if none is left. In an assessment the lesson does not report that a
// joint is too loose, so a trainee that believes the step done continues with the next one.
const lesson::LessonStep* next_step(const lesson::Lesson& lesson, const StepPlan& plan);

// A step that a trainee is about to do.
struct NextStep {
    const lesson::LessonStep& step;
    double nut_angle = 0.0;  // rad, of its joint
};

// Draws the plan for the step `next`. `before`: the previous plan.
StepPlan make_step_plan(const TraineeProfile& profile, Random& random, const servo::Setup& setup,
                        const lesson::Lesson& lesson, const NextStep& next, const StepPlan& before);

}  // namespace bolt::trainees
