// The previous session: kept beside the new one until the next recording replaces it.
#include <doctest/doctest.h>
#include <unistd.h>

#include <set>

#include "game/session/session_file.hpp"
#include "tests/session/child.hpp"
#include "tests/session/support.hpp"

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

void check_session(const std::filesystem::path& path, bool complete, std::size_t ticks) {
    CAPTURE(path);
    const auto reader = SessionReader::open(path);
    if (!reader) FAIL_CHECK(reader.error().message());
    if (!reader) return;
    CHECK(reader->complete() == complete);
    CHECK(reader->tick_count() == ticks);
    CHECK(script_mismatch(*reader).empty());
}

using Names = std::set<std::string>;

Names names_in(const Folder& folder) {
    Names names;
    for (const auto& file : std::filesystem::directory_iterator(folder.path()))
        names.insert(file.path().filename().string());
    return names;
}

}  // namespace

TEST_CASE("Previous session: kept for one generation, complete or cut short") {
    const Folder folder;
    const auto path = folder / "a.session";
    const auto previous = folder / "a.previous.session";
    script_session(path, 25);
    CHECK(names_in(folder) == Names{"a.session"});
    const std::string first = bytes_of(path);

    script_session(path, 35);
    CHECK(names_in(folder) == Names{"a.session", "a.previous.session"});
    check_session(path, true, 35);
    CHECK(bytes_of(previous) == first);

    {
        auto writer = create_script(path);
        REQUIRE(writer);
        REQUIRE(play_script(*writer, 15));
    }
    check_session(path, false, 15);
    check_session(previous, true, 35);

    script_session(path, 5);
    CHECK(names_in(folder) == Names{"a.session", "a.previous.session"});
    check_session(path, true, 5);
    check_session(previous, false, 15);
}

TEST_CASE("Previous session: exists as soon as the new session does") {
    const Folder folder;
    script_session(folder / "a.session", 25);
    const auto writer = create_script(folder / "a.session");
    REQUIRE(writer);
    check_session(folder / "a.session", false, 0);
    check_session(folder / "a.previous.session", true, 25);
}

TEST_CASE("Previous session: the log of a killed process is kept with its session") {
    const Folder folder;
    leave_cut_short(folder / "a.session", true);
    SUBCASE("without an earlier one") {}
    SUBCASE("with the log of an earlier one") {
        leave_cut_short(folder / "a.previous.session", true);
        put_bytes(folder / "a.previous.session-journal", "half a journal");
    }
    script_session(folder / "a.session", 5);
    CHECK(names_in(folder) == Names{"a.session", "a.previous.session"});
    check_session(folder / "a.session", true, 5);
    check_session(folder / "a.previous.session", false, 20);
}

TEST_CASE("Previous session: a session without ticks does not replace it") {
    const Folder folder;
    const auto path = folder / "a.session";
    script_session(path, 25);
    for (int i = 0; i < 3; ++i) REQUIRE(create_script(path));
    put_bytes(path, "");
    script_session(path, 5);
    check_session(path, true, 5);
    check_session(folder / "a.previous.session", true, 25);
}

TEST_CASE("Previous session: a damaged file or another file is kept unchanged") {
    const Folder folder;
    const auto path = folder / "a.session";
    SUBCASE("a text file") { put_bytes(path, "not a session\n"); }
    SUBCASE("a session cut off") { put_bytes(path, bytes_of(script_session(path, 25)).substr(0, 9000)); }
    const std::string before = bytes_of(path);
    script_session(path, 5);
    check_session(path, true, 5);
    CHECK(bytes_of(folder / "a.previous.session") == before);
    CHECK(names_in(folder) == Names{"a.session", "a.previous.session"});
}

TEST_CASE("Previous session: a read-only cut-short session is kept with its log") {
    const Folder folder;
    const auto path = folder / "a.session";
    leave_cut_short(path, false);
    for (const char* suffix : {"", "-wal"})
        std::filesystem::permissions(path.string() + suffix, std::filesystem::perms(0444));
    std::filesystem::permissions(folder.path(), std::filesystem::perms(0777));
    const ChildEnd end = run_child([&](const auto&) {
        constexpr uid_t nobody = 65534;  // may not create hard links to root's files either
        if (::getuid() == 0 && ::setuid(nobody) != 0) return 1;
        if (::access(path.c_str(), W_OK) == 0) return 2;
        script_session(path, 5);
        return 0;
    });
    CHECK(end.code == 0);
    CHECK(names_in(folder) == Names{"a.session", "a.previous.session", "a.previous.session-wal"});
    check_session(path, true, 5);
    check_session(folder / "a.previous.session", false, 20);
}

TEST_CASE("Previous session: kept after a kill just before the replacement") {
    const Folder folder;
    script_session(folder / "a.session", 25);
    std::filesystem::create_hard_link(folder / "a.session", folder / "a.previous.session");
    put_bytes(folder / "a.session.part", "half a file");
    put_bytes(folder / "a.session.lock", "");
    put_bytes(folder / "a.previous.session.lock", "");
    script_session(folder / "a.session", 5);
    CHECK(names_in(folder) == Names{"a.session", "a.previous.session"});
    check_session(folder / "a.session", true, 5);
    check_session(folder / "a.previous.session", true, 25);
}

TEST_CASE("Previous session: a session that cannot be kept is not replaced") {
    const Folder folder;
    const auto path = folder / "a.session";
    const auto previous = folder / "a.previous.session";
    const auto refusal = [&] {
        const auto writer = create_script(path);
        REQUIRE_FALSE(writer);
        return writer.error().message();
    };
    SUBCASE("a folder has that name") {
        script_session(path, 25);
        std::filesystem::create_directory(previous);
        CHECK(refusal().find("cannot be kept as " + previous.string()) != std::string::npos);
        CHECK(std::filesystem::is_directory(previous));
        CHECK(names_in(folder) == Names{"a.session", "a.previous.session"});
        check_session(path, true, 25);
    }
    SUBCASE("another writer records into that name") {
        script_session(path, 25);
        auto writer = create_script(previous);
        REQUIRE(writer);
        CHECK(refusal() == previous.string() +
                               ": another program is recording into this file; expected another file, or "
                               "the end of that recording");
        REQUIRE(play_script(*writer, 35));
        REQUIRE(writer->finish({}));
        check_session(path, true, 25);
        check_session(previous, true, 35);
    }
    SUBCASE("a reader has the log open") {
        leave_cut_short(path, true);
        const auto reader = SessionReader::open(path);
        REQUIRE(reader);
        CHECK(refusal() ==
              path.string() +
                  ": cannot be replaced while it is open elsewhere; expected a file that nobody has "
                  "open");
        CHECK(script_mismatch(*reader).empty());
        check_session(path, false, 20);
        CHECK_FALSE(std::filesystem::exists(previous));
    }
}

TEST_CASE("Previous session: with a symbolic link it is kept beside the file, not beside the link") {
    const Folder folder;
    std::filesystem::create_directory(folder / "far");
    script_session(folder / "far/b.session", 25);
    std::filesystem::create_symlink(folder / "far/b.session", folder / "link");
    script_session(folder / "link", 5);
    check_session(folder / "far/b.previous.session", true, 25);
    check_session(folder / "far/b.session", true, 5);
}

TEST_CASE("Previous session: names with dots or without an extension work") {
    const Folder folder;
    for (const auto& [name, previous] : {std::pair("a", "a.previous"),
                                         {"a.b.c", "a.b.previous.c"},
                                         {".a", ".a.previous"},
                                         {"a b'?#%", "a b'?#%.previous"}}) {
        script_session(folder / name, 15);
        script_session(folder / name, 5);
        check_session(folder / previous, true, 15);
    }
}
