// Mistakes in the view: why something was one and what to do, for some seconds. In assessment none is shown.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/lesson/lesson.hpp"

namespace bolt::hints {

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

// Every event of the lesson goes through here; those that are no mistakes change nothing. A step that is
// taken back takes what is said of it along.
void note(Mistakes& mistakes, const lesson::Lesson& lesson, const lesson::Event& event);

const std::optional<Mistake>& update(Mistakes& mistakes, double dt);

std::string say_why(const words::Words& words, const Mistake& mistake);
std::string say_what_to_do(const words::Words& words, const Mistake& mistake);

}  // namespace bolt::hints
