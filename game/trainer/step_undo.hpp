// Steps that are to be taken back: because a key was pressed, or, in a guided lesson, because of a mistake,
// which returns to the beginning of its step and never of the lesson.
#pragma once

#include <optional>

#include "game/session/lesson_session.hpp"

namespace bolt::trainer {

struct StepUndo {
    std::optional<std::size_t> to;  // the step that is to begin again
    bool by_mistake = false;        // nobody asked: it waits until the hand is off the nut
    double wished_for = 0.0;        // s
};

// The step the trainee is at, and is shown: one that a mistake begins anew is as good as due, also while the
// hand is still on its way off the nut. None after the last.
const lesson::Step* due(const StepUndo& back, const lesson::Lesson& lesson);

// By so many steps from the one that is due: 0 begins it anew. An assessment takes nothing back.
void go_back(StepUndo& back, const lesson::Lesson& lesson, std::size_t steps);

// What the lesson has seen, every event of it.
void note(StepUndo& back, const lesson::Lesson& lesson, const lesson::Event& event);

// A key's wish that cannot be granted is forgotten: nothing leaps when nobody expects it any more.
void wait(StepUndo& back, double seconds);

// By how many steps, as the lesson stands now: work that ends a step on the way out is taken back as well.
// None: nothing is wished.
std::optional<std::size_t> steps_back(const StepUndo& back, const lesson::Lesson& lesson);

// Whether there are more ticks to come. Of the last step, too, a mistake is taken back: until then the lesson
// is not over.
bool goes_on(const StepUndo& back, const session::Course& course);

}  // namespace bolt::trainer
