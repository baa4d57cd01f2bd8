// The session file: one SQLite database, written as the lesson runs and safe against the process dying at any
// moment.
//
// Tables: meta(key, value) — header and state; obstacle(id, name) — what could be bumped into;
// tick_chunk(first_tick, count, data) — up to a second of ticks, as chunk.hpp says; event(...);
// joint_result(...), by joint index; score_reason(...); servo_time(...) — how the servo's thread kept its
// time, where there was one; seal(name, rows, sum) — what each table holds, so that damage is noticed. Every
// second is one commit, so that a killed process loses at most the one that was being collected. meta 'state'
// is 'recording' until finish() makes it 'complete'.
//
// While it is recorded, and after a kill, the newest part is in a -wal file beside it; finish() leaves one
// file. A -shm and a .lock file are also there as long as it is recorded; what a kill leaves of them is in
// nobody's way.
//
// What was recorded is not thrown away by the next recording: "a.previous.session" is the session that was
// "a.session" before, complete or cut short, until the one after that takes its place.
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
#include "game/record/tick.hpp"
#include "haptics/servo/timing.hpp"

namespace bolt::record {

// Something that a wrench can bump into, as TickRecord::touched numbers it.
struct ObstacleName {
    std::int32_t id = 0;
    std::string name;
};

struct Header {
    std::string assembly;       // name
    std::string assembly_file;  // path as it was given, for messages
    std::string assembly_text;  // the file's exact text: a session can be replayed without the folder
    std::string variant;
    std::string law;            // "published", "mechanistic"
    std::string mode;           // "guided", "practice", "assessment"
    std::string task;           // "tighten", "loosen"
    std::string operator_name;  // "expert", …, or "person"
    std::uint64_t seed = 0;
    double dt = 0.001;    // s
    std::string program;  // name and version that wrote it

    // What else decided the ticks; all empty in a session of format 1, which does not say.
    std::string guide;      // "on", "off": whether a guiding force led to the due joint
    std::string obstacles;  // "none", or the files that the wrench met, each with its size and its sum
    std::string device;     // what it takes (device_text.hpp)
    std::string servo;      // "virtual time", or the rate of the thread in words
    std::vector<ObstacleName> obstacle_names;

    std::string view_help;  // "on", "off": of a simulated trainee; empty: a person, or it is not said
    std::string tool;       // its name in the assembly; empty before format 4, which knew the first alone
    std::string hand;       // "left", "right": that worked; empty: it is not said
};

// Move-only. All errors name the file. After an error everything committed before stays readable, and every
// later call gives the same error. A commit waits for the file: not for the thread that renders forces.
// Joints are numbered in the order of their first update(). Destroyed without finish(), it keeps what was
// collected.
class Writer {
  public:
    // Makes a missing folder. A file that is at `path` is kept beside it as <stem>.previous<extension>, all
    // of it in one file, in place of the one kept before; only a session that was cut short before its first
    // commit, which holds no tick, is replaced without being kept. If another writer, in this or in another
    // program, is recording into `path`, or the file is open elsewhere, that is an error and harms nothing:
    // of several that create at the same time one succeeds, and has the file until finish() or its end.
    static Result<Writer> create(const std::filesystem::path& path, const Header& header);
    Writer(Writer&& other) noexcept;
    Writer& operator=(Writer&& other) noexcept;
    ~Writer();

    Status append(const TickRecord& tick);              // commits when a second is full
    Status add(const lesson::Event& event);             // committed with the chunk that is being collected
    Status update(const lesson::JointResult& result);   // latest state of a joint, by id; committed likewise
    Status keep(const servo::Timing& timing);           // of the servo's thread, latest state; likewise
    Status finish(const lesson::LessonResult& result);  // flushes, writes all results, marks complete

  private:
    struct State;
    explicit Writer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

class Reader {
  public:
    // Opens a complete or cut-short session; a file that is none gives an error that says so.
    static Result<Reader> open(const std::filesystem::path& path);
    Reader(Reader&& other) noexcept;
    Reader& operator=(Reader&& other) noexcept;
    ~Reader();

    [[nodiscard]] const Header& header() const;
    [[nodiscard]] bool complete() const;  // false: the session was cut short
    [[nodiscard]] std::uint64_t tick_count() const;
    [[nodiscard]] std::string file() const;

    Result<lesson::LessonResult> result() const;  // what is known, also when cut short
    Result<std::vector<lesson::Event>> events() const;
    Result<std::optional<servo::Timing>> timing() const;  // none: no thread ran, or it was not recorded

    // Calls `visit(first_tick, ticks)` chunk after chunk, in order; a damaged chunk is an error that names
    // it.
    Status for_each_chunk(const std::function<void(std::uint64_t, std::span<const TickRecord>)>& visit) const;

  private:
    struct State;
    explicit Reader(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace bolt::record
