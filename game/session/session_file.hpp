// The session file: one SQLite database, written while the lesson runs. It stays readable if the process dies
// at any moment.
//
// Tables: meta(key, value), header and state; obstacle(id, name), the possible obstacles of the wrench;
// tick_chunk(first_tick, count, data), up to one second of ticks (recorded_tick.hpp); event(...);
// joint_result(...), by joint index; score_reason(...); servo_time(...), the timing of the servo's thread, if
// one ran; seal(name, rows, sum), the checksum of each table. Each second is one commit, so a killed process
// loses at most the last second. meta 'state' is 'recording' until finish() sets 'complete'.
//
// During the recording, and after a kill, the newest part is in a -wal file beside it; finish() leaves one
// file. A -shm and a .lock file exist during the recording; they are harmless if a kill leaves them.
//
// The next recording keeps the previous one: "a.session" becomes "a.previous.session", complete or cut short,
// and replaces an older "a.previous.session".
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/lesson/result.hpp"
#include "game/session/recorded_tick.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/joint/stage.hpp"
#include "haptics/servo/servo_thread.hpp"

namespace bolt::session {

// An obstacle's name, for TickRecord::touched.
struct ObstacleName {
    collision::ObstacleId id;  // one that has a file_number (recorded_tick.hpp)
    std::string name;
};

// The kind of trainee. `unrecorded`: the session is from an older program, which did not record it.
enum class TraineeKind : std::uint8_t { unrecorded, person, simulated };

// The properties of a recorded lesson. The file stores them as text (header.cpp).
struct Header {
    std::string assembly;       // name
    std::string assembly_file;  // path as given by the user, for messages
    std::string assembly_text;  // the file's exact text, so that a session replays without the folder
    std::string variant;
    joint::Law law = joint::Law::mechanistic;
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    // "person", or the simulated trainee's profile: "expert", … The key in the file is "operator".
    std::string trainee_profile;
    std::uint64_t seed = 0;
    double dt = 0.001;    // s
    std::string program;  // name and version of the writing program

    // Further inputs of the ticks; none in format 1, which does not store them.
    std::optional<bool> guide;                  // the guiding force towards the due joint
    std::optional<std::string> contact_models;  // their files with size and checksum; empty: no obstacles
    std::optional<force::OutputLimits> device;
    std::optional<double> servo_rate;  // Hz, of the servo's thread; 0: virtual time
    std::vector<ObstacleName> obstacle_names;

    std::optional<bool> view_help;   // only of a simulated trainee
    std::string tool;                // name in the assembly; empty before format 4: the assembly's first tool
    std::optional<hand::Side> hand;  // the working hand; none if unknown

    // The name given with --trainee, which may be empty. None in sessions of older programs, which stored a
    // person's typed name in `trainee_profile`.
    std::optional<std::string> trainee;
};

// "virtual time", or the rate as text.
std::string servo_text(double rate);

// Determines the kind of trainee without using the trainee's name. The first condition that holds decides:
//   `trainee` is set                  person if `trainee_profile` is "person", otherwise simulated
//   `view_help` is set                simulated: only sessions of simulated trainees record it
//   `trainee_profile` is "person"     person
//   `tool` is not empty               person: the format is 4 or newer, in which every session of a simulated
//                                     trainee has `view_help`
//   none of these                     unrecorded
TraineeKind trainee_kind(const Header& header);

// The trainee's name; empty if none is recorded. A simulated trainee has one only if --trainee gave it.
std::string trainee_name(const Header& header);

// Move-only. All errors name the file. After an error everything committed before stays readable, and each
// later call returns the same error. A commit blocks on the file system, so never call this from the servo
// thread. Joints are numbered in the order of their first update(). Destruction without finish() commits the
// ticks collected so far.
class SessionWriter {
  public:
    // Creates a missing folder. Keeps an existing file at `path` beside it as <stem>.previous<extension>,
    // merged into one file, and replaces an earlier one of that name; a session without any tick is not kept.
    // Fails, and changes nothing, if another writer in this or another program is recording into `path` or
    // has it open. If several writers create it at the same time, one succeeds and holds the file until
    // finish() or its destruction.
    static Result<SessionWriter> create(const std::filesystem::path& path, const Header& header);
    SessionWriter(SessionWriter&& other) noexcept;
    SessionWriter& operator=(SessionWriter&& other) noexcept;
    ~SessionWriter();

    // Commits after each full second, together with the data of the next three functions.
    Status append(const TickRecord& tick);
    Status add(const lesson::LessonEvent& event);
    // Replaces the result of the joint with the same id.
    Status update(const lesson::JointResult& result);
    // Replaces the timing of the servo's thread.
    Status record_timing(const servo::Timing& timing);
    // Commits, writes all results and marks the session as complete.
    Status finish(const lesson::LessonResult& result);

  private:
    struct State;
    explicit SessionWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

class SessionReader {
  public:
    // Opens a complete or cut-short session; fails if the file is not a session.
    static Result<SessionReader> open(const std::filesystem::path& path);
    SessionReader(SessionReader&& other) noexcept;
    SessionReader& operator=(SessionReader&& other) noexcept;
    ~SessionReader();

    [[nodiscard]] const Header& header() const;
    [[nodiscard]] bool complete() const;  // false: the session was cut short
    [[nodiscard]] std::uint64_t tick_count() const;
    [[nodiscard]] std::string file() const;

    Result<lesson::LessonResult> result() const;  // as far as recorded, if cut short
    Result<std::vector<lesson::LessonEvent>> events() const;
    Result<std::optional<servo::Timing>> timing() const;  // none if no thread ran, or in format 1

    // Calls `visit(first_tick, ticks)` for each chunk in order; fails at a damaged chunk and names it.
    Status for_each_chunk(const std::function<void(std::uint64_t, std::span<const TickRecord>)>& visit) const;

  private:
    struct State;
    explicit SessionReader(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace bolt::session
