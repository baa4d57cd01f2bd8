// The process dies: at every single file operation, and at random moments.
#include <doctest/doctest.h>

#include "game/session/session_file.hpp"
#include "tests/session/child.hpp"
#include "tests/session/faulty_disk.hpp"
#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

constexpr std::size_t script_ticks = 55;
constexpr std::size_t old_ticks = 5;

// Records the script to its end over what is at `path` and reports: 1 when the file was made, then 1 + ticks.
int record_script(const std::filesystem::path& path, const std::function<void(std::uint64_t)>& report) {
    auto writer = create_script(path);
    if (!writer) return 1;
    report(1);
    if (!play_script(*writer, script_ticks, [&](std::size_t ticks) { report(1 + ticks); })) return 2;
    return writer->finish({}) ? 0 : 3;
}

// What has to be true of the file, whenever its writer died after `reported`.
void check_left(const std::filesystem::path& path, std::uint64_t reported) {
    const auto reader = Reader::open(path);
    if (!reader) FAIL_CHECK(reader.error().message());
    if (!reader) return;
    const std::string mismatch = script_mismatch(*reader);
    CHECK_MESSAGE(mismatch.empty(), mismatch);
    if (reported == 0 && reader->complete()) {
        CHECK(reader->tick_count() == old_ticks);  // the session that was to be replaced
        return;
    }
    const auto previous = Reader::open(path.parent_path() / "a.previous.session");
    if (!previous) FAIL_CHECK(previous.error().message());
    if (previous) CHECK((previous->complete() && previous->tick_count() == old_ticks));
    const std::uint64_t appended = reported == 0 ? 0 : reported - 1;
    CHECK(reader->tick_count() <= script_ticks);
    CHECK(reader->tick_count() + script_second >= appended);
    if (reader->complete()) CHECK(reader->tick_count() == script_ticks);
    if (appended < script_ticks) CHECK_FALSE(reader->complete());
}

// How many ticks there are, all of them right.
std::size_t left_under(const std::filesystem::path& path) {
    const auto reader = Reader::open(path);
    if (!reader) FAIL_CHECK(reader.error().message());
    if (!reader) return 0;
    CHECK(script_mismatch(*reader).empty());
    return reader->tick_count();
}

}  // namespace

TEST_CASE("Killed process: a process killed at any file operation leaves a session that opens") {
    int survived = -1;
    int cut_short = 0;
    for (int at = 0; survived < 0; ++at) {
        REQUIRE(at < 2000);
        CAPTURE(at);
        const Folder folder;
        const auto path = folder / "a.session";
        script_session(path, old_ticks);
        const ChildEnd end = run_child([&](const auto& report) {
            const FaultyDisk disk(Fault::kill, at);
            return record_script(path, report);
        });
        if (!end.killed) {
            CHECK(end.code == 0);
            survived = at;
        }
        check_left(path, end.last_report);
        const auto reader = Reader::open(path);
        if (reader && !reader->complete()) ++cut_short;
    }
    // The operations really were in the way: several a second of the script, and more to begin and to end
    // with.
    CHECK(survived > 40);
    CHECK(cut_short > 20);
}

TEST_CASE("Killed process: a process killed while it replaces a cut-short session loses nothing of it") {
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
            const FaultyDisk disk(Fault::kill, at);
            return create_script(path) ? 0 : 1;
        });
        if (!end.killed) {
            CHECK(end.code == 0);
            survived = at;
        }
        if (left_under(path) == cut_ticks)
            ++still_there;
        else
            CHECK(left_under(folder / "a.previous.session") == cut_ticks);
        // What died in the middle is in nobody's way either.
        CHECK(create_script(path));
        CHECK(left_under(path) == 0);
        CHECK(left_under(folder / "a.previous.session") == cut_ticks);
    }
    CHECK(still_there > 10);
    CHECK(survived > still_there);
}

TEST_CASE("Killed process: a process killed at a random moment loses at most the last second") {
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
        const auto reader = Reader::open(path);
        REQUIRE(reader);
        CHECK_FALSE(reader->complete());
        CHECK(reader->tick_count() + script_second >= end.last_report - 1);
        CHECK(reader->tick_count() % script_second == 0);
        const std::string mismatch = script_mismatch(*reader);
        CHECK_MESSAGE(mismatch.empty(), mismatch);
    }
}
