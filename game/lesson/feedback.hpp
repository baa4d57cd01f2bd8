// Explains the result of a lesson: why points were deducted and what to do better next time.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "content/words/words.hpp"
#include "game/lesson/lesson.hpp"

namespace bolt::lesson {

struct Remark {
    double points = 0.0;  // as in the score: negative where they were taken
    std::optional<words::Key> key;
    std::vector<words::Place> places;
    std::string text;  // of a session that was read again: it has no more than that
};

struct Review {
    std::vector<Remark> reasons;     // in the order of the score's
    std::vector<words::Key> advice;  // one to three; what cost most first
};

// `assembly`: that of the lesson, under its law (under_law), for the torque and angle windows.
Review review(const content::Assembly& assembly, const lesson::LessonResult& result);

std::string say(const words::Words& words, const Remark& remark);

}  // namespace bolt::lesson
