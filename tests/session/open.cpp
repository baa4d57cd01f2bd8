// SessionReader::open with files that are not sessions, and without changing any file.
#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sqlite3.h>
#include <unistd.h>

#include "game/session/session_file.hpp"
#include "game/session/tables.hpp"
#include "tests/session/child.hpp"
#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

std::string refusal(const std::filesystem::path& path) {
    const auto reader = SessionReader::open(path);
    REQUIRE_FALSE(reader);
    CHECK(reader.error().code == ErrorCode::failed);
    CHECK(reader.error().file == path.string());
    return reader.error().message();
}

bool contains(const std::string& text, const char* part) { return text.find(part) != std::string::npos; }

void run_sql(const std::filesystem::path& path, const char* sql) {
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open(path.c_str(), &database) == SQLITE_OK);
    REQUIRE(sqlite3_exec(database, sql, nullptr, nullptr, nullptr) == SQLITE_OK);
    sqlite3_close(database);
}

}  // namespace

TEST_CASE("Reader: a file that is not a session is refused with the reason") {
    const Folder folder;
    const auto path = folder / "a.session";
    CHECK(contains(refusal(path), "No such file"));
    CHECK(contains(refusal(folder.path()), "not a session file"));
    put_bytes(path, "");
    CHECK(contains(refusal(path), "is empty"));
    put_bytes(path, "time_s,torque_Nm\n0.0,1.0\n");
    CHECK(contains(refusal(path), "not a database"));
    put_bytes(path, std::string(100'000, 'x'));
    CHECK(contains(refusal(path), "not a database"));
    put_bytes(path, std::string("SQLite format 3\0", 16));
    CHECK(contains(refusal(path), "not a database"));
    CHECK(contains(refusal("/dev/null"), "not a session file"));
}

TEST_CASE("Reader: another program's database is refused") {
    const Folder folder;
    run_sql(folder / "other", "CREATE TABLE meta(key, value); INSERT INTO meta VALUES('state', 'complete')");
    CHECK(contains(refusal(folder / "other"), "another program"));
    run_sql(folder / "claims",
            "PRAGMA application_id = 1112493140; PRAGMA user_version = 1; CREATE TABLE t(x)");
    CHECK(contains(refusal(folder / "claims"), "no such table"));
}

TEST_CASE("Reader: a session of a newer version is refused with both numbers") {
    const Folder folder;
    const auto path = script_session(folder / "a.session", 5);
    const std::int64_t newer = format_version + 1;
    run_sql(path, fmt::format("PRAGMA user_version = {}", newer).c_str());
    const std::string expected =
        fmt::format("newer version: its format is {}; expected a format from 1 to {}", newer, format_version);
    CHECK(contains(refusal(path), expected.c_str()));
    run_sql(path, "PRAGMA user_version = 0");
    CHECK(contains(refusal(path), "unknown format 0"));
}

TEST_CASE("Reader: a session with a gap, a lost row or an altered value is refused") {
    const Folder folder;
    const auto path = script_session(folder / "a.session", 45);
    SUBCASE("a chunk from the middle") {
        run_sql(path, "DELETE FROM tick_chunk WHERE first_tick = 20");
        CHECK(contains(refusal(path), "tick_chunk"));
    }
    SUBCASE("the last chunk") {
        run_sql(path, "DELETE FROM tick_chunk WHERE first_tick = 40");
        CHECK(contains(refusal(path), "tick_chunk has lost rows"));
    }
    SUBCASE("another seed") {
        run_sql(path, "UPDATE meta SET value = '8' WHERE key = 'seed'");
        CHECK(contains(refusal(path), "meta has altered values"));
    }
    SUBCASE("a better score") {
        run_sql(path, "UPDATE meta SET value = '100' WHERE key = 'score'");
        CHECK(contains(refusal(path), "meta has altered values"));
    }
    SUBCASE("a row with a count of 2^62 ticks") {
        run_sql(path, "UPDATE tick_chunk SET count = 4611686018427387904 WHERE first_tick = 40");
        CHECK(contains(refusal(path), "a value out of range"));
    }
}

TEST_CASE("Reader: an altered event or result gives an error; the rest stays readable") {
    const Folder folder;
    const auto path = script_session(folder / "a.session", 45);
    run_sql(
        path,
        "UPDATE event SET value = value + 1 WHERE ordinal = 2; DELETE FROM joint_result WHERE ordinal = 0");
    const auto reader = SessionReader::open(path);
    REQUIRE(reader);
    const auto events = reader->events();
    REQUIRE_FALSE(events);
    CHECK(contains(events.error().message(), "event has altered values"));
    CHECK(events.error().file == path.string());
    const auto result = reader->result();
    REQUIRE_FALSE(result);
    CHECK(contains(result.error().message(), "joint_result has lost rows"));
    CHECK(all_ticks(*reader).size() == 45);
}

TEST_CASE("Reader: the error names a damaged chunk, and the chunks before it are read") {
    const Folder folder;
    const auto path = script_session(folder / "a.session", 45);
    run_sql(path,
            "UPDATE tick_chunk SET data = substr(data, 1, 100) || x'00' || substr(data, 102) WHERE "
            "first_tick = 20");
    const auto reader = SessionReader::open(path);
    REQUIRE(reader);
    std::size_t seen = 0;
    const Status read =
        reader->for_each_chunk([&](std::uint64_t, std::span<const TickRecord> t) { seen += t.size(); });
    REQUIRE_FALSE(read);
    CHECK(read.error().file == path.string());
    CHECK(contains(read.error().what, "the ticks from 20 on are damaged"));
    CHECK(seen == 20);
}

TEST_CASE("Reader: functions in a file's schema are not called") {
    const Folder folder;
    const auto path = script_session(folder / "a.session", 5);
    run_sql(path,
            "DROP TABLE event; CREATE VIEW event AS SELECT 0 AS ordinal, 0 AS tick, '' AS kind, 0 AS joint, "
            "0 AS value, hex(randomblob(100000000)) AS text");
    const auto reader = SessionReader::open(path);
    REQUIRE(reader);
    CHECK_FALSE(reader->events());
}

TEST_CASE("Reader: reading does not change complete and cut-short sessions") {
    const Folder folder;
    const auto path = folder / "a.session";
    bool complete = false;
    SUBCASE("complete") { script_session(path, 25), complete = true; }
    SUBCASE("cut short, with its log and index") { leave_cut_short(path, true); }
    SUBCASE("cut short, with its log") { leave_cut_short(path, false); }
    const std::string before = bytes_of(path);
    const std::string log = bytes_of(path.string() + "-wal");
    for (int i = 0; i < 2; ++i) {
        const auto reader = SessionReader::open(path);
        REQUIRE(reader);
        CHECK(reader->complete() == complete);
        CHECK(reader->tick_count() == (complete ? 25 : 20));
        CHECK(script_mismatch(*reader).empty());
    }
    CHECK(bytes_of(path) == before);
    CHECK(bytes_of(path.string() + "-wal") == log);
    CHECK(std::filesystem::exists(path.string() + "-wal") == !complete);
}

TEST_CASE("Reader: sessions open in a read-only folder") {
    const Folder folder;
    const auto path = folder / "a.session";
    std::size_t ticks = 20;
    SUBCASE("complete") { script_session(path, 25), ticks = 25; }
    SUBCASE("cut short, with its log and index") { leave_cut_short(path, true); }
    SUBCASE("cut short, with its log") { leave_cut_short(path, false); }
    SUBCASE("cut short, and the log was not copied") {
        leave_cut_short(path, false);
        std::filesystem::remove(path.string() + "-wal");
        ticks = 0;
    }
    for (const char* suffix : {"", "-wal", "-shm"})
        if (std::filesystem::exists(path.string() + suffix))
            std::filesystem::permissions(path.string() + suffix, std::filesystem::perms(0444));
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0555));
    const ChildEnd end = run_child([&](const auto&) {
        constexpr uid_t nobody = 65534;  // root may write everywhere
        if (::getuid() == 0 && ::setuid(nobody) != 0) return 1;
        if (::access(folder.path().c_str(), W_OK) == 0) return 2;
        const auto reader = SessionReader::open(path);
        if (!reader) {
            (void)std::fputs((reader.error().message() + "\n").c_str(), stderr);
            return 3;
        }
        if (reader->tick_count() != ticks) return 4;
        return script_mismatch(*reader).empty() ? 0 : 5;
    });
    CHECK(end.code == 0);
}
