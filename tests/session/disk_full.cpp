// A full disk at each file operation, and the system's limit on the size of a file.
#include <doctest/doctest.h>
#include <signal.h>
#include <sys/resource.h>

#include "game/session/session_file.hpp"
#include "tests/session/child.hpp"
#include "tests/session/faulty_disk.hpp"
#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

constexpr std::size_t script_ticks = 55;

// Every call after an error, with its required result.
void check_refuses_alike(SessionWriter& writer, const Error& first) {
    const Status more[] = {writer.append({}), writer.add({}), writer.update({}), writer.finish({})};
    for (const Status& status : more) {
        REQUIRE_FALSE(status);
        CHECK(status.error().message() == first.message());
    }
}

}  // namespace

TEST_CASE("Disk full: from any file operation on it is an error, and the committed data is kept") {
    const Folder folder;
    const auto path = folder / "a.session";
    int failures = 0;
    for (int at = 0;; ++at) {
        REQUIRE(at < 2000);
        CAPTURE(at);
        script_session(path, 5);
        std::size_t appended = 0;
        bool made = false;
        Status done;
        {
            const FaultyDisk disk(DiskFault::full, at);
            auto writer = create_script(path);
            made = writer.has_value();
            if (!made) {
                done = fail(writer.error());
            } else {
                done = play_script(*writer, script_ticks, [&](std::size_t ticks) { appended = ticks; });
                if (done) done = writer->finish({});
                if (!done) check_refuses_alike(*writer, done.error());
            }
        }
        const auto reader = SessionReader::open(path);
        if (!reader) FAIL_CHECK(reader.error().message());
        REQUIRE(reader);
        const std::string mismatch = script_mismatch(*reader);
        CHECK_MESSAGE(mismatch.empty(), mismatch);
        if (done) {
            CHECK(reader->complete());
            CHECK(reader->tick_count() == script_ticks);
            break;
        }
        ++failures;
        CHECK(done.error().code == ErrorCode::failed);
        CHECK(done.error().file == path.string());
        if (!made) continue;
        CHECK(reader->tick_count() + script_second > appended);
        if (!reader->complete()) CHECK(done.error().what.find(" is kept") != std::string::npos);
    }
    CHECK(failures > 20);
}

TEST_CASE("Disk full: the system's limit on file size is an error, and the committed data is kept") {
    const Folder folder;
    const auto path = folder / "a.session";
    const ChildEnd end = run_child([&](const auto& report) {
        ::signal(SIGXFSZ, SIG_IGN);
        const rlimit limit{200'000, 200'000};
        if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) return 1;
        auto writer = create_script(path);
        if (!writer) return 2;
        const Status done = play_script(*writer, 1'000'000, report);
        if (done) return 3;
        if (done.error().file != path.string()) return 4;
        if (done.error().what.find("cannot be written: ") == std::string::npos) return 5;
        if (done.error().what.find(" is kept") == std::string::npos) return 6;
        const Status again = writer->append({});
        return !again && again.error().message() == done.error().message() ? 0 : 7;
    });
    CHECK(end.code == 0);
    CHECK(end.last_report > 100);
    const auto reader = SessionReader::open(path);
    REQUIRE(reader);
    CHECK_FALSE(reader->complete());
    CHECK(reader->tick_count() + script_second > end.last_report);
    CHECK(script_mismatch(*reader).empty());
}
