// A replayed session in memory: its components at regular times, so that any moment can be shown at once.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "game/analysis/session_data.hpp"
#include "game/lesson/feedback.hpp"
#include "game/session/replay.hpp"
#include "game/world/world.hpp"

namespace bolt::viewer {

// A mark on the time line. Chapters are the steps of the lesson.
struct TimelineMark {
    double time = 0.0;  // s
    int joint = -1;     // index; −1: none
    bool mistake = false;
    lesson::LessonEvent event;
    std::optional<lesson::Mistake> explanation;  // of a mistake, for any language
};

// The components of the simulation at one moment (game/world/world.hpp).
struct RecordedState {
    world::ServoClock clock;
    world::ConstrainedTool tool;
    world::ToolState contact;
    world::GuidingForce guiding;
    world::DeviceForce force;
    world::WorkingHand hand;
    std::vector<world::Joint> joints;  // by index
};
RecordedState state_of(const world::ReadHaptics& world);
// Writes all components but WorkingHand::rest.
void write_state(const world::WriteHaptics& world, const RecordedState& state);

struct Recording {
    session::SessionSetup start;  // setup and state at the start of the lesson; not advanced
    analysis::SessionData data;
    double period = 0.02;               // s between two of `states`
    std::vector<RecordedState> states;  // the first one at the start of the lesson
    // Copies of the lesson, one whenever a step began, ended or was undone, without events and step_starts.
    std::vector<lesson::Lesson> lessons;
    std::vector<std::size_t> lesson_index;  // for each of `states` an index into `lessons`
    std::vector<TimelineMark> marks;        // in order of time
    std::uint64_t mismatches = 0;           // ticks that differ from the recording

    [[nodiscard]] double duration() const { return static_cast<double>(states.size() - 1) * period; }
    // The state nearest to the time.
    [[nodiscard]] std::size_t index_at(double time) const;
    // The step of the lesson at the time: the last mark before it that is no mistake. Null before the first.
    [[nodiscard]] const TimelineMark* chapter_at(double time) const;
    // The start (s) of another chapter. `by` 1: the next one; the end of the session if there is none. `by`
    // −1: the present one, or in its first second the previous one; the start of the session if there is
    // none.
    [[nodiscard]] double neighbouring_chapter(double time, int by) const;
};

// Replays the whole session. The recording must not be moved, because lessons refer to its assembly. Fails if
// the session has no tick, cannot be read, or cannot be restored (session::restore_setup()).
Result<std::unique_ptr<Recording>> replay_session(const session::SessionReader& session);

}  // namespace bolt::viewer
