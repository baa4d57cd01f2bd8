// The tables of a session file and their checksums, shared by the sources of game/session only. The keys of
// table meta are in header.hpp.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "game/lesson/result.hpp"
#include "game/session/database.hpp"
#include "game/session/recorded_tick.hpp"
#include "game/session/session_file.hpp"
#include "haptics/servo/servo_thread.hpp"

namespace bolt::session {

inline constexpr std::int64_t application_id = 0x424F4C54;  // "BOLT", in SQLite's header
// user_version; incremented when an older program would misread the file. 2: contacts, faults, servo timing;
// 3: undo; 4: the tool and its set torque; 5: the assembly's text may have its own targets under the
// published law; 6: lesson::LawAdaptation::yield_end, and the text may have parameters of the published law
// for a joint type; 7: several tools; 8: the second wrench, and tools that yield; 9: tools yield under the
// mechanistic law only, and the choice of a tool is judged; 10: rings, sockets and keys round six corners;
// 11: the tool can leave a gap that is narrower than its skin (servo::Setup::allows_narrow_gaps).
inline constexpr std::int64_t format_version = 11, oldest_format = 1;

// Angles are in radians, as in memory, so that reading returns the written bits. The columns `rehits` and
// `order_errors` have older names: they hold JointResult::done_already and out_of_turn.
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

// Parses the whole text as a number; none if that fails.
template <class Number>
std::optional<Number> number(std::string_view text) {
    Number value{};
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (status != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return value;
}

inline constexpr const char* state_recording = "recording";
inline constexpr const char* state_complete = "complete";

// Number of ticks in a commit: one second, at least one tick. None if `dt` in s is out of range.
inline std::optional<std::size_t> ticks_per_commit(double dt) {
    if (!std::isfinite(dt) || dt <= 0.0) return std::nullopt;
    const double ticks = std::round(1.0 / dt);
    if (ticks > static_cast<double>(max_chunk_ticks)) return std::nullopt;
    return ticks < 1.0 ? std::size_t{1} : static_cast<std::size_t>(ticks);
}

// A table row of the timing of a servo thread.
struct TimingRow {
    std::string name;  // "wake_up", "compute", "period": a histogram; "missed": only its count
    std::uint64_t count = 0;
    std::uint64_t min = 0, max = 0;  // ns
    double sum = 0.0;                // ns
    std::vector<std::byte> bins;     // non-empty bins: index u32, count u64, little-endian
};

inline constexpr std::size_t timing_rows = 4;
std::array<TimingRow, timing_rows> rows_of(const servo::Timing& timing);

// Adds a row to `timing`. Returns false if the row is not one that rows_of() makes.
bool read_row(servo::Timing& timing, const TimingRow& row);

// A checksum of a table: the number of its rows and the sum of their hashes. SQLite checks the structure of
// its pages but not their values; the checksum detects a changed number, a lost row or an altered text.
//
// The sum does not depend on the order of rows, so changing a row costs a subtraction and an addition. It
// protects against damage, not against forgery.
struct TableChecksum {
    std::uint64_t rows = 0;
    std::uint64_t sum = 0;

    void add(std::uint64_t hash) { ++rows, sum += hash; }
    void change(std::uint64_t before, std::uint64_t after) { sum += after - before; }
    bool operator==(const TableChecksum&) const = default;
};

// The hash of a row. All NaNs are equal and −0 equals 0, because SQLite does not distinguish them.
std::uint64_t meta_row_hash(std::string_view key, std::string_view value);
std::uint64_t chunk_row_hash(std::uint64_t first_tick, std::uint64_t count);
std::uint64_t row_hash(const ObstacleName& obstacle);
std::uint64_t row_hash(const TimingRow& row);
std::uint64_t row_hash(std::uint64_t ordinal, const lesson::LessonEvent& event);
std::uint64_t row_hash(std::uint64_t ordinal, const lesson::JointResult& result);
std::uint64_t row_hash(std::uint64_t ordinal, const lesson::Deduction& reason);

struct TableChecksums {
    TableChecksum meta, chunk, event, joint, reason, obstacle, servo_time;
};

// A row of table joint_result while the session is written.
struct JointRow {
    lesson::JointResult result;
    std::optional<std::uint64_t> written_hash;  // the row's hash; none before it is first written
    bool changed = true;                        // differs from the row in the file
};

// Each function writes rows and adds them to their table's checksum. Call them inside a transaction that ends
// with put_checksums(). After a failure the checksums are invalid.
Status put_header(Database& database, const Header& header, TableChecksums& checksums);
Status put_chunk(Database& database, std::uint64_t first_tick, std::size_t count,
                 std::span<const std::byte> data, TableChecksums& checksums);
Status put_events(Database& database, std::uint64_t first_ordinal,
                  std::span<const lesson::LessonEvent> events, TableChecksums& checksums);
Status put_timing(Database& database, const servo::Timing& timing, TableChecksums& checksums);
Status put_changed(Database& database, std::span<JointRow> joints, TableChecksums& checksums);
// Writes score, duration and reasons, and marks the session as complete. Joints are written by put_changed().
Status put_result(Database& database, const lesson::LessonResult& result, TableChecksums& checksums);
Status put_checksums(Database& database, const TableChecksums& checksums);

// Runs `statements` as one transaction: the file gets all of them or none.
template <class Statements>
Status transaction(Database& database, Statements statements) {
    Status done = database.execute("BEGIN IMMEDIATE");
    if (done) done = statements();
    if (done) done = database.execute("COMMIT");
    // After some errors SQLite has already rolled back; this statement then fails, as expected.
    if (!done) (void)database.execute("ROLLBACK");
    return done;
}

}  // namespace bolt::session
