// The layout of a session file, shared by the writer and the reader only.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "game/session/chunk.hpp"

namespace bolt::session {

inline constexpr std::int64_t application_id = 0x424F4C54;  // "BOLT", in SQLite's header
// user_version; incremented when an older program would misread the file. 2: contacts, faults, servo timing;
// 3: undo; 4: the tool and its set torque; 5: the assembly's text may have its own targets under the
// published law.
inline constexpr std::int64_t format_version = 5, oldest_format = 1;

// Angles are in radians, as in memory, so that reading returns the written bits.
inline constexpr const char* schema = R"(
CREATE TABLE meta(key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE tick_chunk(first_tick INTEGER PRIMARY KEY, count INTEGER NOT NULL, data BLOB NOT NULL);
CREATE TABLE event(ordinal INTEGER PRIMARY KEY, tick INTEGER NOT NULL, kind TEXT NOT NULL, joint INTEGER NOT NULL,
                   value REAL, text TEXT NOT NULL);
CREATE TABLE joint_result(ordinal INTEGER PRIMARY KEY, id TEXT NOT NULL, torque_Nm REAL, angle_rad REAL, clamp_N REAL,
                          clamp_at_release_N REAL, torque_verdict TEXT NOT NULL, angle_verdict TEXT NOT NULL,
                          overall TEXT NOT NULL, condition TEXT NOT NULL, strokes INTEGER NOT NULL,
                          rehits INTEGER NOT NULL, order_errors INTEGER NOT NULL);
CREATE TABLE score_reason(ordinal INTEGER PRIMARY KEY, points REAL, text TEXT NOT NULL);
CREATE TABLE obstacle(id INTEGER PRIMARY KEY, name TEXT NOT NULL);
CREATE TABLE servo_time(name TEXT PRIMARY KEY, count INTEGER NOT NULL, least_ns INTEGER NOT NULL,
                        greatest_ns INTEGER NOT NULL, sum_ns REAL NOT NULL, bins BLOB NOT NULL) WITHOUT ROWID;
CREATE TABLE seal(name TEXT PRIMARY KEY, rows INTEGER NOT NULL, sum INTEGER NOT NULL) WITHOUT ROWID;
)";

namespace key {
inline constexpr const char* assembly = "assembly";
inline constexpr const char* assembly_file = "assembly_file";
inline constexpr const char* assembly_text = "assembly_text";
inline constexpr const char* variant = "variant";
inline constexpr const char* law = "law";
inline constexpr const char* mode = "mode";
inline constexpr const char* task = "task";
inline constexpr const char* operator_name = "operator";
inline constexpr const char* seed = "seed";
inline constexpr const char* dt = "dt_s";
inline constexpr const char* program = "program";
inline constexpr const char* guide = "guide";  // this and the next three: since format 2
inline constexpr const char* obstacles = "obstacles";
inline constexpr const char* device = "device";
inline constexpr const char* servo = "servo";
inline constexpr const char* view_help = "view_help";  // optional
inline constexpr const char* tool = "tool";            // since format 4
inline constexpr const char* hand = "hand";            // optional
inline constexpr const char* trainee = "trainee";      // optional

inline constexpr const char* state = "state";
inline constexpr const char* duration = "duration_s";  // from here on: complete sessions only
inline constexpr const char* score = "score";
inline constexpr const char* finished = "finished";
}  // namespace key

inline constexpr const char* state_recording = "recording";
inline constexpr const char* state_complete = "complete";

// Number of ticks in a commit: one second, at least one tick. None if `dt` is outside the range of sessions.
inline std::optional<std::size_t> ticks_per_commit(double dt) {
    if (!std::isfinite(dt) || dt <= 0.0) return std::nullopt;
    const double ticks = std::round(1.0 / dt);
    if (ticks > static_cast<double>(max_chunk_ticks)) return std::nullopt;
    return ticks < 1.0 ? std::size_t{1} : static_cast<std::size_t>(ticks);
}

}  // namespace bolt::session
