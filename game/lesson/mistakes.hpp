// Shows a mistake for some seconds, with its reason and its remedy. In assessment none is shown.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/lesson/lesson.hpp"

namespace bolt::lesson {

struct Mistake {
    lesson::Cause cause = lesson::Cause::none;  // in the order of their gravity
    int joint = -1;                             // of which it is said
    words::Key why = "mistake.out_of_turn";
    words::Key what_to_do = "mistake.out_of_turn.do";
    std::vector<words::Place> places;
};

struct Mistakes {
    std::optional<Mistake> shown;
    std::optional<Mistake> waiting;  // as grave or graver: shown when the other could be read
    double stands = 0.0;             // s that `shown` has been
};

inline constexpr double mistake_stands = 6.0;    // s
inline constexpr double shortest_mistake = 1.5;  // s, before a graver one takes its place

// Takes each event of the lesson; only mistakes and undone steps have an effect. Undoing a step hides its
// mistake.
void note(Mistakes& mistakes, const lesson::Lesson& lesson, const lesson::Event& event);

const std::optional<Mistake>& update(Mistakes& mistakes, double dt);

std::string say_why(const words::Words& words, const Mistake& mistake);
std::string say_what_to_do(const words::Words& words, const Mistake& mistake);

}  // namespace bolt::lesson
