// Writes rows into the tables of a session file and adds each to its table's checksum.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "game/lesson/result.hpp"
#include "game/session/database.hpp"
#include "game/session/session_file.hpp"
#include "game/session/table_checksum.hpp"

namespace bolt::session {

struct TableChecksums {
    TableChecksum meta, chunk, event, joint, reason, obstacle, servo_time;
};

struct JointRow {
    lesson::JointResult result;
    std::optional<std::uint64_t> sealed;  // the row's hash; none before it is first written
    bool changed = true;
};

// Call these inside a transaction that ends with put_checksums(). After a failure the checksums are invalid.
Status put_header(Database& database, const Header& header, TableChecksums& checksums);
Status put_chunk(Database& database, std::uint64_t first_tick, std::size_t count,
                 std::span<const std::byte> data, TableChecksums& checksums);
Status put_events(Database& database, std::uint64_t first_ordinal, std::span<const lesson::Event> events,
                  TableChecksums& checksums);
Status put_timing(Database& database, const servo::Timing& timing, TableChecksums& checksums);
Status put_changed(Database& database, std::span<JointRow> joints, TableChecksums& checksums);
// Writes score, duration and reasons, and marks the session as complete. Joints are written by put_changed().
Status put_result(Database& database, const lesson::LessonResult& result, TableChecksums& checksums);
Status put_checksums(Database& database, const TableChecksums& checksums);

// Runs `statements` as one transaction: the file gets all of it or nothing.
template <class Statements>
Status transaction(Database& database, Statements statements) {
    Status done = database.execute("BEGIN IMMEDIATE");
    if (done) done = statements();
    if (done) done = database.execute("COMMIT");
    // After some errors SQLite has already rolled back; the failure of this is then expected.
    if (!done) (void)database.execute("ROLLBACK");
    return done;
}

}  // namespace bolt::session
