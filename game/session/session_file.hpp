// The session file: one SQLite database, written while the lesson runs. It stays readable if the process dies
// at any moment.
//
// Tables: meta(key, value), header and state; obstacle(id, name), the possible obstacles of the wrench;
// tick_chunk(first_tick, count, data), up to one second of ticks (recorded_tick.hpp); event(...);
// joint_result(...), one row for each joint; score_reason(...); servo_time(...), the timing of the servo's
// thread, if one ran; seal(name, rows, sum), the checksum of each table. Each second is one commit, so a
// killed process loses at most the last second. meta 'state' is 'recording' until finish() sets 'complete'.
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
#include <vector>

#include "engine/base/result.hpp"
#include "game/lesson/result.hpp"
#include "game/session/header.hpp"
#include "game/session/recorded_tick.hpp"
#include "haptics/servo/servo_thread.hpp"

namespace bolt::session {

// Move-only. All errors name the file. After an error everything committed before stays readable, and each
// later call returns the same error. A commit blocks on the file system, so never call this from the servo
// thread. Joints are numbered in the order of their first update(). Destruction without finish() commits the
// ticks collected so far.
class SessionWriter {
  public:
    // Creates a missing folder. Merges an existing file at `path` with its -wal file and renames it to
    // <stem>.previous<extension>, which replaces an earlier file of that name; a session without any tick is
    // deleted.
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
    // Commits, and waits until everything is on the disk.
    Status synchronise();
    // Commits, writes all results and marks the session as complete.
    Status finish(const lesson::LessonResult& result);

  private:
    struct State;
    explicit SessionWriter(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

// Reads only the header: quick, and possible also if ticks or results are damaged. Header::obstacle_names and
// Header::rules, which follow from the format, have their defaults.
Result<Header> read_header(const std::filesystem::path& path);

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
