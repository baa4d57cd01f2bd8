#include "game/trainer/going_back.hpp"

#include <algorithm>

namespace bolt::trainer {

namespace {

constexpr double patience = 6.0;  // s

}  // namespace

void go_back(GoingBack& back, const lesson::Lesson& lesson, std::size_t steps) {
    if (lesson.mode == lesson::Mode::assessment || steps > lesson.current) return;
    back = {lesson.current - steps};
}

void note(GoingBack& back, const lesson::Lesson& lesson, const lesson::Event& event) {
    if (event.kind == "back") back = {};
    if (event.cause == lesson::Cause::none || lesson.mode != lesson::Mode::guided) return;
    back = {std::min(back.to.value_or(lesson.current), lesson.current), true};
}

void wait(GoingBack& back, double seconds) {
    if (!back.to || back.by_mistake) return;
    back.wished_for += seconds;
    if (back.wished_for > patience) back = {};
}

std::optional<std::size_t> steps_back(const GoingBack& back, const lesson::Lesson& lesson) {
    if (!back.to || *back.to > lesson.current) return std::nullopt;
    return lesson.current - *back.to;
}

}  // namespace bolt::trainer
