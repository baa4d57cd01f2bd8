#include "game/trainer/step_undo.hpp"

#include <algorithm>

namespace bolt::trainer {

namespace {

constexpr double patience = 6.0;  // s

std::size_t step_at(const StepUndo& back, const lesson::Lesson& lesson) {
    return back.by_mistake ? *back.to : lesson.current;
}

}  // namespace

const lesson::Step* due(const StepUndo& back, const lesson::Lesson& lesson) {
    const std::size_t at = step_at(back, lesson);
    return at < lesson.steps.size() ? &lesson.steps[at] : nullptr;
}

void go_back(StepUndo& back, const lesson::Lesson& lesson, std::size_t steps) {
    const std::size_t at = step_at(back, lesson);
    if (lesson.mode == lesson::Mode::assessment || steps > at) return;
    back = {at - steps, back.by_mistake};
}

void note(StepUndo& back, const lesson::Lesson& lesson, const lesson::Event& event) {
    if (event.kind == "back") back = {};
    if (event.cause == lesson::Cause::none || lesson.mode != lesson::Mode::guided) return;
    back = {std::min(back.to.value_or(lesson.current), lesson.current), true};
}

void wait(StepUndo& back, double seconds) {
    if (!back.to || back.by_mistake) return;
    back.wished_for += seconds;
    if (back.wished_for > patience) back = {};
}

std::optional<std::size_t> steps_back(const StepUndo& back, const lesson::Lesson& lesson) {
    if (!back.to || *back.to > lesson.current) return std::nullopt;
    return lesson.current - *back.to;
}

bool goes_on(const StepUndo& back, const session::Course& course) {
    if (!course.over()) return true;
    const auto steps = steps_back(back, course.lesson());
    return back.by_mistake && steps && course.undo_by(*steps) != 0;
}

}  // namespace bolt::trainer
