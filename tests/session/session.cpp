#include "game/session/session_file.hpp"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <sched.h>
#include <sqlite3.h>
#include <sys/mount.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <limits>

#include "tests/session/child.hpp"
#include "tests/session/support.hpp"
#include "tests/support/skip.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

SessionWriter created(const std::filesystem::path& path, double dt = 0.001) {
    auto writer = SessionWriter::create(path, sample_header(dt));
    if (!writer) MESSAGE(writer.error().message());
    REQUIRE(writer);
    return std::move(*writer);
}

SessionReader opened(const std::filesystem::path& path) {
    auto reader = SessionReader::open(path);
    if (!reader) MESSAGE(reader.error().message());
    REQUIRE(reader);
    return std::move(*reader);
}

std::size_t files_in(const Folder& folder) {
    const std::filesystem::directory_iterator files(folder.path());
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

}  // namespace

TEST_CASE("Session file: reading returns every bit of the ticks, in whole seconds or not") {
    for (const double dt : {0.001, 0.00025, 1.0, 2.5, 0.3}) {
        for (const std::size_t count : {0U, 1U, 999U, 1000U, 1001U, 4001U}) {
            const Folder folder;
            CAPTURE(dt);
            CAPTURE(count);
            if (dt >= 1.0 && count > 1) continue;  // one commit for each tick
            const std::vector<TickRecord> ticks = random_ticks(count, count);
            SessionWriter writer = created(folder / "a.session", dt);
            for (const TickRecord& tick : ticks) REQUIRE(writer.append(tick));
            REQUIRE(writer.finish({}));
            const SessionReader reader = opened(folder / "a.session");
            CHECK(reader.complete());
            CHECK(reader.tick_count() == count);
            CHECK(same(all_ticks(reader), ticks));
            CHECK(same(reader.header(), sample_header(dt)));
            CHECK(files_in(folder) == 1);
        }
    }
}

TEST_CASE("Session file: reading returns the events and results as written") {
    const Folder folder;
    std::vector<lesson::LessonEvent> events;
    for (std::uint64_t i = 0; i < 300; ++i)
        events.push_back({i * 17, i % 2 == 0 ? lesson::EventKind::engage : lesson::EventKind::mistake,
                          static_cast<int>(i % 13) - 1, 0.1 * static_cast<double>(i),
                          "“text” " + std::to_string(i)});
    events.push_back({std::numeric_limits<std::uint64_t>::max(), lesson::EventKind::note, -1, -0.0, ""});
    events.push_back({0, lesson::EventKind::note, 2147483647, std::numeric_limits<double>::quiet_NaN(),
                      std::string("a\0b", 3)});
    events.push_back({0, lesson::EventKind::note, -2147483647, std::numeric_limits<double>::infinity(), "x"});
    events.push_back({0, lesson::EventKind::note, 0, std::numeric_limits<double>::denorm_min(), "x"});
    lesson::LessonResult result = sample_result();
    SUBCASE("ordinary numbers") {}
    SUBCASE("numbers that SQL cannot store") {
        result.score = std::numeric_limits<double>::quiet_NaN();
        result.duration = std::numeric_limits<double>::infinity();
        result.joints[2].torque = std::numeric_limits<double>::quiet_NaN();
        result.joints[3].clamp = -0.0;
        result.reasons[0].points = -std::numeric_limits<double>::infinity();
    }

    SessionWriter writer = created(folder / "a.session", 0.01);
    for (const lesson::JointResult& joint : result.joints) {
        lesson::JointResult start;
        start.id = joint.id;
        REQUIRE(writer.update(start));
    }
    for (const lesson::LessonEvent& event : events) {
        REQUIRE(writer.add(event));
        REQUIRE(writer.append({}));
    }
    REQUIRE(writer.finish(result));

    const SessionReader reader = opened(folder / "a.session");
    const auto read_events = reader.events();
    REQUIRE(read_events);
    REQUIRE(read_events->size() == events.size());
    for (std::size_t i = 0; i < events.size(); ++i) CHECK(same((*read_events)[i], events[i]));
    const auto read_result = reader.result();
    REQUIRE(read_result);
    CHECK(same(*read_result, result));
}

TEST_CASE("Session file: joints keep the order of their first update") {
    const Folder folder;
    SessionWriter writer = created(folder / "a.session", 1.0);
    for (const char* id : {"C", "A", "B"}) {
        lesson::JointResult joint;
        joint.id = id;
        REQUIRE(writer.update(joint));
    }
    REQUIRE(writer.append({}));
    lesson::LessonResult result;
    result.joints.resize(3);
    for (std::size_t i = 0; i < 3; ++i) result.joints[i].id = std::string(1, static_cast<char>('A' + i));
    REQUIRE(writer.finish(result));
    const auto read = opened(folder / "a.session").result();
    REQUIRE(read);
    REQUIRE(read->joints.size() == 3);
    CHECK(read->joints[0].id == "C");
    CHECK(read->joints[1].id == "A");
    CHECK(read->joints[2].id == "B");
}

TEST_CASE("Session file: without finish() a session keeps all data and is not complete") {
    const Folder folder;
    {
        SessionWriter writer = created(folder / "a.session", 0.1);
        REQUIRE(play_script(writer, 33));
    }
    const SessionReader reader = opened(folder / "a.session");
    CHECK_FALSE(reader.complete());
    CHECK(reader.tick_count() == 33);
    CHECK(script_mismatch(reader).empty());
    const auto result = reader.result();
    REQUIRE(result);
    CHECK(result->duration == doctest::Approx(3.3));
    CHECK_FALSE(result->finished);
}

TEST_CASE("Session file: a finished writer refuses more data and changes nothing") {
    const Folder folder;
    SessionWriter writer = created(folder / "a.session");
    REQUIRE(writer.append({}));
    REQUIRE(writer.finish(sample_result()));
    const std::string before = bytes_of(folder / "a.session");
    const Status more[] = {writer.append({}), writer.add({}), writer.update({}), writer.finish({})};
    for (const Status& status : more) {
        REQUIRE_FALSE(status);
        CHECK(status.error().code == ErrorCode::failed);
        CHECK(status.error().file == (folder / "a.session").string());
        CHECK(status.error().what.find("is complete") != std::string::npos);
    }
    CHECK(bytes_of(folder / "a.session") == before);
}

TEST_CASE("Session file: an invalid tick is refused and leaves no gap") {
    const Folder folder;
    SessionWriter writer = created(folder / "a.session");
    TickRecord wrong;
    wrong.stage = 200;
    REQUIRE(writer.append({}));
    CHECK_FALSE(writer.append(wrong));
    REQUIRE(writer.append({}));
    REQUIRE(writer.finish({}));
    CHECK(opened(folder / "a.session").tick_count() == 2);
}

TEST_CASE("Session file: a reader sees the session as it was when opened, also during the recording") {
    const Folder folder;
    SessionWriter writer = created(folder / "a.session", 0.1);
    const SessionReader empty = opened(folder / "a.session");
    REQUIRE(play_script(writer, 25));
    const SessionReader reader = opened(folder / "a.session");
    CHECK(empty.tick_count() == 0);
    CHECK(script_mismatch(empty).empty());
    CHECK(reader.tick_count() == 20);
    REQUIRE(writer.finish({}));
    CHECK(script_mismatch(reader).empty());
    CHECK_FALSE(reader.complete());
    const SessionReader later = opened(folder / "a.session");
    CHECK(later.complete());
    CHECK(later.tick_count() == 25);
    CHECK(script_mismatch(later).empty());
}

TEST_CASE("Session file: creating replaces an existing file and its logs") {
    const Folder folder;
    const auto path = folder / "a.session";
    SUBCASE("a complete session") { script_session(path, 25); }
    SUBCASE("a text file") { put_bytes(path, "not a session\n"); }
    SUBCASE("a cut-short session with its log") {
        SessionWriter old = created(folder / "old.session", 0.1);
        REQUIRE(play_script(old, 25));
        for (const char* suffix : {"", "-wal", "-shm"})
            put_bytes(path.string() + suffix, bytes_of((folder / "old.session").string() + suffix));
        CHECK(opened(path).tick_count() == 20);
    }
    SUBCASE("a log without its session") {
        SessionWriter old = created(folder / "old.session", 0.1);
        REQUIRE(play_script(old, 25));
        put_bytes(path.string() + "-wal", bytes_of((folder / "old.session").string() + "-wal"));
    }
    SUBCASE("leftovers of a killed creation") {
        put_bytes(path.string() + ".part", "half a file");
        put_bytes(path.string() + ".part-wal", "half a log");
        put_bytes(path.string() + "-journal", "half a journal");
    }
    SessionWriter writer = created(path, 0.1);
    REQUIRE(play_script(writer, 5));
    REQUIRE(writer.finish({}));
    const SessionReader reader = opened(path);
    CHECK(reader.tick_count() == 5);
    CHECK(script_mismatch(reader).empty());
    CHECK_FALSE(std::filesystem::exists(path.string() + ".part"));
    CHECK_FALSE(std::filesystem::exists(path.string() + "-wal"));
    CHECK_FALSE(std::filesystem::exists(path.string() + "-journal"));
}

TEST_CASE("Session file: a session that is being recorded is not replaced") {
    const Folder folder;
    SessionWriter writer = created(folder / "a.session", 0.1);
    REQUIRE(play_script(writer, 15));
    const auto second = SessionWriter::create(folder / "a.session", sample_header(0.1));
    REQUIRE_FALSE(second);
    CHECK(second.error().what == "another program is recording into this file");
    CHECK(second.error().file == (folder / "a.session").string());
    CHECK(files_in(folder) == 4);  // with its -wal, -shm and .lock
    REQUIRE(writer.finish({}));
    CHECK(opened(folder / "a.session").tick_count() == 15);
    CHECK(files_in(folder) == 1);
}

TEST_CASE("Session file: a missing folder is created") {
    const Folder folder;
    const auto path = folder / "out/of/the way/100% #1?.session";
    script_session(path, 25);
    CHECK(opened(path).tick_count() == 25);
}

TEST_CASE("Session file: a symbolic link to a session works") {
    const Folder folder;
    std::filesystem::create_directory(folder / "far");
    put_bytes(folder / "far/a.session", "to be replaced");
    std::filesystem::create_symlink(folder / "far/a.session", folder / "link");
    SessionWriter writer = created(folder / "link", 0.1);
    REQUIRE(play_script(writer, 15));
    CHECK(opened(folder / "link").tick_count() == 10);
    REQUIRE(writer.finish({}));
    CHECK(opened(folder / "link").tick_count() == 15);
    CHECK(std::filesystem::is_symlink(folder / "link"));
}

TEST_CASE("Session file: the error of a failed creation names the file") {
    const Folder folder;
    put_bytes(folder / "file", "");
    std::filesystem::create_directory(folder / "folder");
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    for (const char* name : {"file/a.session", "folder", "pipe"}) {
        CAPTURE(name);
        const auto writer = SessionWriter::create(folder / name, sample_header(0.001));
        REQUIRE_FALSE(writer);
        CHECK(writer.error().code == ErrorCode::failed);
        CHECK(writer.error().file == (folder / name).string());
    }
    CHECK(std::filesystem::is_directory(folder / "folder"));
    CHECK(std::filesystem::is_fifo(folder / "pipe"));
}

TEST_CASE("Session file: the error for a folder that is not writable gives the reason") {
    const auto reason_at = [](const std::filesystem::path& path) {
        const auto writer = SessionWriter::create(path, sample_header(0.001));
        return writer ? std::string("it was made") : writer.error().what;
    };
    // Not even root can create files in the kernel's folders.
    for (const std::filesystem::path path : {"/sys/a.session", "/proc/a.session"}) {
        CAPTURE(path);
        errno = 0;
        REQUIRE(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600) < 0);
        const std::string expected = std::string("its folder is not writable: ") + std::strerror(errno);
        CHECK(reason_at(path) == expected);
    }
    const Folder folder;
    put_bytes(folder / "file", "");
    CHECK(reason_at(folder / "file/a.session") == "its folder cannot be created: Not a directory");

    const auto status_of = [&](const std::filesystem::path& path, const char* expected) {
        const std::string reason = reason_at(path);
        if (reason == expected) return 0;
        (void)std::fputs((reason + "\n").c_str(), stderr);
        return 1;
    };
    constexpr int cannot_be_shown = 77;
    std::filesystem::create_directory(folder / "closed");
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
    std::filesystem::permissions(folder / "closed", std::filesystem::perms(0555));
    const ChildEnd denied = run_child([&](const auto&) {
        constexpr uid_t nobody = 65534;  // root may write everywhere
        if (::getuid() == 0 && ::setuid(nobody) != 0) return cannot_be_shown;
        if (status_of(folder / "closed/a.session", "its folder is not writable: Permission denied") != 0)
            return 1;
        return status_of(folder / "closed/new/a.session", "its folder cannot be created: Permission denied");
    });
    if (denied.code == cannot_be_shown)
        bolt::test::skip_part("a folder without write permission needs a user other than root");
    CHECK((denied.code == 0 || denied.code == cannot_be_shown));

    const ChildEnd read_only = run_child([&](const auto&) {
        if (::unshare(CLONE_NEWUSER | CLONE_NEWNS) != 0 && ::unshare(CLONE_NEWNS) != 0)
            return cannot_be_shown;
        (void)::mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr);
        if (::mount("none", (folder / "closed").c_str(), "tmpfs", MS_RDONLY, nullptr) != 0)
            return cannot_be_shown;
        return status_of(folder / "closed/a.session", "its folder is not writable: Read-only file system");
    });
    if (read_only.code == cannot_be_shown)
        bolt::test::skip_part("a read-only file system cannot be mounted here");
    CHECK((read_only.code == 0 || read_only.code == cannot_be_shown));
}

TEST_CASE("Session file: a tick length out of range is refused") {
    const Folder folder;
    for (const double dt : {0.0, -0.001, 1.0e-6, std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity()}) {
        CAPTURE(dt);
        CHECK_FALSE(SessionWriter::create(folder / "a.session", sample_header(dt)));
    }
    CHECK(files_in(folder) == 0);
}

TEST_CASE("Session file: it is a valid database with names and units in its columns") {
    const Folder folder;
    const auto path = script_session(folder / "a.session", 25);
    sqlite3* database = nullptr;
    REQUIRE(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK);
    const auto first = [&](const char* sql) {
        std::string text;
        const auto keep = [](void* out, int, char** values, char**) {
            *static_cast<std::string*>(out) = values[0];
            return 1;
        };
        sqlite3_exec(database, sql, keep, &text, nullptr);
        return text;
    };
    CHECK(first("PRAGMA integrity_check") == "ok");
    CHECK(first("PRAGMA journal_mode") == "delete");  // one file, no log
    CHECK(first("SELECT value FROM meta WHERE key = 'state'") == "complete");
    CHECK(first("SELECT torque_Nm FROM joint_result WHERE id = 'even'") == "2.4");
    CHECK(first("SELECT text FROM event WHERE tick = 10") == "at 10");
    CHECK(first("SELECT sum(count) FROM tick_chunk") == "25");
    sqlite3_close(database);
}
