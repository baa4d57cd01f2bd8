#include "game/trainer/step_undo.hpp"

#include <algorithm>
#include <array>

namespace bolt::trainer {

namespace {

constexpr double expiry = 6.0;  // s

std::size_t shown_step(const StepUndo& undo, const lesson::Lesson& lesson) {
    return undo.by_mistake ? *undo.target : lesson.current;
}

}  // namespace

const lesson::LessonStep* due(const StepUndo& undo, const lesson::Lesson& lesson) {
    const std::size_t step = shown_step(undo, lesson);
    return step < lesson.steps.size() ? &lesson.steps[step] : nullptr;
}

void request_undo(StepUndo& undo, const lesson::Lesson& lesson, std::size_t steps) {
    const std::size_t step = shown_step(undo, lesson);
    if (lesson.mode == lesson::Mode::assessment || steps > step) return;
    undo = {step - steps, undo.by_mistake};
}

bool undo_repairs(lesson::MistakeKind mistake) {
    using lesson::MistakeKind;
    constexpr std::array beyond_undo{MistakeKind::none, MistakeKind::turned_together, MistakeKind::weak_tool,
                                     MistakeKind::torque_wrench_loosens, MistakeKind::tool_bent};
    return std::find(beyond_undo.begin(), beyond_undo.end(), mistake) == beyond_undo.end();
}

void observe(StepUndo& undo, const lesson::Lesson& lesson, const lesson::LessonEvent& event) {
    if (event.kind == lesson::EventKind::undo) undo = {};
    if (!undo_repairs(event.mistake) || lesson.mode != lesson::Mode::guided) return;
    undo = {std::min(undo.target.value_or(lesson.current), lesson.current), true};
}

void update(StepUndo& undo, double seconds) {
    if (!undo.target || undo.by_mistake) return;
    undo.age += seconds;
    if (undo.age > expiry) undo = {};
}

std::optional<std::size_t> steps_to_undo(const StepUndo& undo, const lesson::Lesson& lesson) {
    if (!undo.target || *undo.target > lesson.current) return std::nullopt;
    return lesson.current - *undo.target;
}

bool continues(const StepUndo& undo, const session::LessonSession& session) {
    if (!session.finished()) return true;
    const auto steps = steps_to_undo(undo, session.lesson());
    return undo.by_mistake && steps && session.restore_action(*steps) != 0;
}

}  // namespace bolt::trainer
