// Continues a lesson whose recording ended before its last step, because the program was killed or closed.
// The ticks of the recording are repeated from the beginning of the lesson, which restores servo, lesson and
// world to the bit, and are recorded again into a new session file. That file therefore has the whole lesson
// and one result, replays like any other, and names the ticks of the interruptions
// (Header::continued_after). No measure includes the time between the parts, because a session has ticks
// only.
#pragma once

#include <filesystem>

#include "engine/base/result.hpp"
#include "game/session/lesson_session.hpp"
#include "game/session/session_file.hpp"

namespace bolt::session {

// Returns the recording and the number of its ticks to repeat. In an assessment a joint is judged when the
// tool leaves it, so a recording that ends during a hold is cut before that hold: the release after the
// interruption would judge the joint. Fails if the file is damaged, or if the lesson was finished.
Result<InterruptedLesson> read_interrupted(const std::filesystem::path& file);

// Fails, and names the difference, if a lesson with these options is not that of the recording.
Status check_same_lesson(const InterruptedLesson& interrupted, const SessionSetup& start,
                         const LessonOptions& options);

// Repeats the ticks of the interrupted lesson on `start`, for a servo that records nothing, such as that of a
// station. Fails if an output differs from the recorded one or the recording is damaged.
Status repeat_ticks(const InterruptedLesson& interrupted, SessionSetup& start);

}  // namespace bolt::session
