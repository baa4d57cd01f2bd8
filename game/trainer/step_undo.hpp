// Undo of lesson steps: requested by a key, or, in a guided lesson, by a mistake. A mistake restarts its
// step, never the whole lesson.
#pragma once

#include <optional>

#include "game/session/lesson_session.hpp"

namespace bolt::trainer {

// A pending request; it is applied once the hand is off the nut.
struct StepUndo {
    std::optional<std::size_t> target;  // the step to restart; none: no request
    bool by_mistake = false;            // requested by a mistake; such a request does not expire
    double age = 0.0;                   // s since the request
};

// The step to show as due: the lesson's current one, or the one that a pending mistake restarts. Null after
// the last step.
const lesson::LessonStep* due(const StepUndo& undo, const lesson::Lesson& lesson);

// Requests a restart of the step that is `steps` before the due one; 0: of the due step. Ignored in an
// assessment and if there are not so many steps.
void request_undo(StepUndo& undo, const lesson::Lesson& lesson, std::size_t steps);

// True if an undo can repair the mistake. False if nut and bolt turned together, which changes no clamp
// force; for a bent tool, which an undo does not straighten; and for a wrong choice of a tool.
bool undo_repairs(lesson::MistakeKind mistake);

// Call with every event of the lesson. In a guided lesson a mistake that an undo repairs requests an undo.
// The event of the undo clears the request.
void observe(StepUndo& undo, const lesson::Lesson& lesson, const lesson::LessonEvent& event);

// Call once a frame. A key's request expires after a few seconds, so that the lesson does not jump back
// unexpectedly.
void update(StepUndo& undo, double seconds);

// The number of steps to undo from the lesson's current one; none if no request is pending. It grows if the
// trainee completes a step before the request is applied.
std::optional<std::size_t> steps_to_undo(const StepUndo& undo, const lesson::Lesson& lesson);

// True while the lesson goes on: steps remain, or a mistake is pending that can still be undone.
bool continues(const StepUndo& undo, const session::LessonSession& session);

}  // namespace bolt::trainer
