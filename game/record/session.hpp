// The session file: one SQLite database, written as the lesson runs and safe against the process dying at any moment.
//
// Tables: meta(key, value) — header and state; tick_chunk(first_tick, count, data) — up to a second of ticks, columns
// of little-endian values shuffled by byte and compressed with zstd; event(tick, kind, joint, value, text);
// joint_result(...); score_reason(...). Every chunk is committed as it fills, so that a killed process loses at most
// the second that was being collected. meta 'state' is 'recording' until finish() makes it 'complete'.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/lesson/result.hpp"
#include "haptics/servo/io.hpp"

namespace bolt::record {

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
    double dt = 0.001;          // s
    std::string program;        // name and version that wrote it
};

// One tick as it is kept: the input exactly, the output in single precision.
struct TickRecord {
    servo::DeviceSample device;
    std::uint8_t grip = 0;      // servo::Grip
    std::uint8_t enabled = 0;
    std::int16_t guide = -1;
    float force[3] = {0.0F, 0.0F, 0.0F};
    float torque[3] = {0.0F, 0.0F, 0.0F};
    std::int16_t joint = -1;
    std::uint8_t stage = 0;     // joint::Stage
    float wrench_torque = 0.0F;
    float nut_angle = 0.0F;
    float clamp = 0.0F;
};

TickRecord make_record(const servo::Input& input, const servo::Output& output);
servo::Input input_of(const TickRecord& record);

// Move-only. All errors name the file. After an error everything committed before stays readable.
class Writer {
  public:
    // Replaces an existing file at `path`.
    static Result<Writer> create(const std::filesystem::path& path, const Header& header);
    Writer(Writer&&) noexcept;
    Writer& operator=(Writer&&) noexcept;
    ~Writer();

    Status append(const TickRecord& tick);                 // commits when a second is full
    Status add(const lesson::Event& event);                // committed with the chunk that is being collected
    Status update(const lesson::JointResult& result);      // latest state of a joint, by id; committed likewise
    Status finish(const lesson::LessonResult& result);     // flushes, writes all results, marks complete

  private:
    struct State;
    explicit Writer(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

class Reader {
  public:
    // Opens a complete or cut-short session; a file that is none gives an error that says so.
    static Result<Reader> open(const std::filesystem::path& path);
    Reader(Reader&&) noexcept;
    Reader& operator=(Reader&&) noexcept;
    ~Reader();

    [[nodiscard]] const Header& header() const;
    [[nodiscard]] bool complete() const;                   // false: the session was cut short
    [[nodiscard]] std::uint64_t tick_count() const;
    [[nodiscard]] std::string file() const;

    Result<lesson::LessonResult> result() const;           // what is known, also when cut short
    Result<std::vector<lesson::Event>> events() const;

    // Calls `visit(first_tick, ticks)` chunk after chunk, in order; a damaged chunk is an error that names it.
    Status for_each_chunk(const std::function<void(std::uint64_t, std::span<const TickRecord>)>& visit) const;

  private:
    struct State;
    explicit Reader(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace bolt::record
