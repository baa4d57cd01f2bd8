// Killing the process at each file operation and at random times.
#include <doctest/doctest.h>

#include "game/session/session_file.hpp"
#include "tests/session/child.hpp"
#include "tests/session/faulty_disk.hpp"
#include "tests/session/support.hpp"

namespace session_killed_test {

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

constexpr std::size_t script_ticks = 55;
constexpr std::size_t old_ticks = 5;

// Records the script to its end at `path`, over an existing file. Reports 1 when the file exists, then 1 +
// ticks.
int record_script(const std::filesystem::path& path, const std::function<void(std::uint64_t)>& report) {
    auto writer = create_script(path);
    if (!writer) return 1;
    report(1);
    if (!play_script(*writer, script_ticks, [&](std::size_t ticks) { report(1 + ticks); })) return 2;
    return writer->finish({}) ? 0 : 3;
}

// Checks the file of a writer that died after the report `reported`.
void check_file(const std::filesystem::path& path, std::uint64_t reported) {
    const auto reader = SessionReader::open(path);
    if (!reader) FAIL_CHECK(reader.error().message());
    if (!reader) return;
    const std::string mismatch = script_mismatch(*reader);
    CHECK_MESSAGE(mismatch.empty(), mismatch);
    if (reported == 0 && reader->complete()) {
        CHECK(reader->tick_count() == old_ticks);  // the session before the replacement
        return;
    }
    const auto previous = SessionReader::open(path.parent_path() / "a.previous.session");
    if (!previous) FAIL_CHECK(previous.error().message());
    if (previous) CHECK((previous->complete() && previous->tick_count() == old_ticks));
    const std::uint64_t appended = reported == 0 ? 0 : reported - 1;
    CHECK(reader->tick_count() <= script_ticks);
    CHECK(reader->tick_count() + script_second >= appended);
    if (reader->complete()) CHECK(reader->tick_count() == script_ticks);
    if (appended < script_ticks) CHECK_FALSE(reader->complete());
}

// Number of ticks at `path`; checks that all are right.
std::size_t ticks_at(const std::filesystem::path& path) {
    const auto reader = SessionReader::open(path);
    if (!reader) FAIL_CHECK(reader.error().message());
    if (!reader) return 0;
    CHECK(script_mismatch(*reader).empty());
    return reader->tick_count();
}

}  // namespace

TEST_CASE("Killed process: after a kill at any file operation the session opens") {
    int survived = -1;
    int cut_short = 0;
    for (int at = 0; survived < 0; ++at) {
        REQUIRE(at < 2000);
        CAPTURE(at);
        const Folder folder;
        const auto path = folder / "a.session";
        script_session(path, old_ticks);
        const ChildEnd end = run_child([&](const auto& report) {
            const FaultyDisk disk(DiskFault::kill, at);
            return record_script(path, report);
        });
        if (!end.killed) {
            CHECK(end.code == 0);
            survived = at;
        }
        check_file(path, end.last_report);
        const auto reader = SessionReader::open(path);
        if (reader && !reader->complete()) ++cut_short;
    }
    // The script has several operations a second, and more at its start and end.
    CHECK(survived > 40);
    CHECK(cut_short > 20);
}

TEST_CASE("Killed process: a kill during the replacement of a cut-short session loses no data of it") {
    constexpr std::size_t cut_ticks = 20;
    int survived = -1;
    int still_there = 0;
    for (int at = 0; survived < 0; ++at) {
        REQUIRE(at < 200);
        CAPTURE(at);
        const Folder folder;
        const auto path = folder / "a.session";
        leave_cut_short(path, at % 2 == 0);
        const ChildEnd end = run_child([&](const auto&) {
            const FaultyDisk disk(DiskFault::kill, at);
            return create_script(path) ? 0 : 1;
        });
        if (!end.killed) {
            CHECK(end.code == 0);
            survived = at;
        }
        if (ticks_at(path) == cut_ticks)
            ++still_there;
        else
            CHECK(ticks_at(folder / "a.previous.session") == cut_ticks);
        // The leftovers of the killed process do not disturb the next recording.
        CHECK(create_script(path));
        CHECK(ticks_at(path) == 0);
        CHECK(ticks_at(folder / "a.previous.session") == cut_ticks);
    }
    CHECK(still_there > 10);
    CHECK(survived > still_there);
}

TEST_CASE("Killed process: a kill at a random time loses at most the last second") {
    const Folder folder;
    const auto path = folder / "a.session";
    Random random(2024);
    for (int round = 0; round < 25; ++round) {
        CAPTURE(round);
        std::filesystem::remove(path);
        for (const char* suffix : {"-wal", "-shm"}) std::filesystem::remove(path.string() + suffix);
        const std::uint64_t kill_at = 1 + random.bits() % 400;
        const ChildEnd end = run_child(
            [&](const auto& report) {
                auto writer = create_script(path);
                if (!writer) return 1;
                report(1);
                constexpr std::size_t forever = 1'000'000;
                const bool played =
                    play_script(*writer, forever, [&](std::size_t t) { report(1 + t); }).has_value();
                return played ? 0 : 2;
            },
            kill_at, random.bits() % 3000);
        REQUIRE(end.killed);
        const auto reader = SessionReader::open(path);
        REQUIRE(reader);
        CHECK_FALSE(reader->complete());
        CHECK(reader->tick_count() + script_second >= end.last_report - 1);
        CHECK(reader->tick_count() % script_second == 0);
        const std::string mismatch = script_mismatch(*reader);
        CHECK_MESSAGE(mismatch.empty(), mismatch);
    }
}

}  // namespace session_killed_test
