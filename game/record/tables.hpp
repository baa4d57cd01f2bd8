// Rows into the tables of a session file, each counted into the seal of its table.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "game/lesson/result.hpp"
#include "game/record/database.hpp"
#include "game/record/seal.hpp"
#include "game/record/session.hpp"

namespace bolt::record {

struct Seals {
    Seal meta, chunk, event, joint, reason, obstacle, servo_time;
};

struct JointRow {
    lesson::JointResult result;
    std::optional<std::uint64_t> sealed;  // the row's part of the seal; none before it is first written
    bool changed = true;
};

// Each belongs in a transaction that put_seals() ends. After a failure the seals are of no more use.
Status put_header(Database& database, const Header& header, Seals& seals);
Status put_chunk(Database& database, std::uint64_t first_tick, std::size_t count,
                 std::span<const std::byte> data, Seals& seals);
Status put_events(Database& database, std::uint64_t first_ordinal, std::span<const lesson::Event> events,
                  Seals& seals);
Status put_timing(Database& database, const servo::Timing& timing, Seals& seals);
Status put_changed(Database& database, std::span<JointRow> joints, Seals& seals);
// The reasons and the numbers, and that the session is complete. The joints are put as changed ones.
Status put_result(Database& database, const lesson::LessonResult& result, Seals& seals);
Status put_seals(Database& database, const Seals& seals);

// Runs `statements` as one transaction: all of it is in the file afterwards, or nothing.
template <class Statements>
Status transaction(Database& database, Statements statements) {
    Status done = database.execute("BEGIN IMMEDIATE");
    if (done) done = statements();
    if (done) done = database.execute("COMMIT");
    // SQLite has rolled back by itself after some errors; then this has nothing to do and says so.
    if (!done) (void)database.execute("ROLLBACK");
    return done;
}

}  // namespace bolt::record
