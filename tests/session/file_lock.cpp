// Several programs that record into the same file.
#include <doctest/doctest.h>
#include <sched.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>

#include "game/session/database.hpp"
#include "game/session/session_file.hpp"
#include "tests/session/child.hpp"
#include "tests/session/support.hpp"

namespace session_file_lock_test {

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

constexpr std::size_t programs = 4;
constexpr std::size_t script_ticks = 35;
constexpr unsigned time_limit_s = 20;  // s, time limit of a child

// Exit status of a program.
constexpr int recorded = 0;
constexpr int refused = 10;
constexpr int failed = 11;

class Pipe {
  public:
    Pipe() {
        if (::pipe(ends_.data()) != 0) std::abort();
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;
    ~Pipe() {
        close(0);
        close(1);
    }
    void signal() const {
        if (::write(ends_[1], "", 1) != 1) ::_exit(failed);
    }
    bool wait() const {  // false: the pipe is closed
        char byte = 0;
        return ::read(ends_[0], &byte, 1) == 1;
    }
    void close(std::size_t end) {
        if (ends_[end] >= 0) (void)::close(ends_[end]);
        ends_[end] = -1;
    }

  private:
    std::array<int, 2> ends_{};
};

int exit_status(const Error& error, const std::filesystem::path& path) {
    if (error.what == "another program is recording into this file" && error.file == path.string())
        return refused;
    (void)std::fputs((error.message() + "\n").c_str(), stderr);
    return failed;
}

// Records the script. Calls `before_end` after create() has succeeded or failed.
template <class Wait>
int record_script(const std::filesystem::path& path, Wait before_end) {
    auto writer = create_script(path);
    before_end();
    if (!writer) return exit_status(writer.error(), path);
    Status done = play_script(*writer, script_ticks);
    if (done) done = writer->finish({});
    return done ? recorded : exit_status(done.error(), path);
}

// Starts all programs at the same time. `hold`: none ends before create() has returned in all of them.
std::array<int, programs> start_together(const std::filesystem::path& path, bool hold) {
    Pipe start;
    Pipe created;
    Pipe end;
    std::array<pid_t, programs> children{};
    (void)std::fflush(nullptr);
    for (pid_t& child : children) {
        child = ::fork();
        if (child < 0) std::abort();
        if (child != 0) continue;
        ::alarm(time_limit_s);
        start.close(1);
        end.close(1);
        (void)start.wait();
        const int code = record_script(path, [&] {
            created.signal();
            if (hold) (void)end.wait();
        });
        ::_exit(code);
    }
    created.close(1);
    start.close(1);
    for (std::size_t i = 0; i < programs; ++i) (void)created.wait();
    end.close(1);
    std::array<int, programs> codes{};
    for (std::size_t i = 0; i < programs; ++i) {
        int status = 0;
        if (::waitpid(children[i], &status, 0) != children[i]) std::abort();
        codes[i] = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }
    return codes;
}

void check_script(const std::filesystem::path& path, std::size_t ticks) {
    const auto reader = SessionReader::open(path);
    if (!reader) FAIL_CHECK(reader.error().message());
    if (!reader) return;
    CHECK(reader->complete());
    CHECK(reader->tick_count() == ticks);
    CHECK(script_mismatch(*reader).empty());
}

}  // namespace

TEST_CASE("File lock: one of the programs that start together records, the others report the lock") {
    for (int round = 0; round < 18; ++round) {
        CAPTURE(round);
        const Folder folder;
        const auto path = folder / "out/a.session";
        const bool over_old = round % 3 == 1;
        if (over_old) script_session(path, 5);
        if (round % 3 == 2) {  // as a killed process leaves it
            std::filesystem::create_directory(folder / "out");
            leave_cut_short(path, true);
            put_bytes(path.string() + ".lock", "");
        }
        const auto codes = start_together(path, true);
        CHECK(std::ranges::count(codes, recorded) == 1);
        CHECK(std::ranges::count(codes, refused) == programs - 1);
        check_script(path, script_ticks);
        if (over_old) check_script(folder / "out/a.previous.session", 5);
        const std::filesystem::directory_iterator files(folder / "out");
        CHECK(std::distance(begin(files), end(files)) == (round % 3 == 0 ? 1 : 2));
    }
}

TEST_CASE("File lock: programs that start and end at any time leave valid sessions") {
    const Folder folder;
    const auto path = folder / "a.session";
    std::ptrdiff_t all = 0;
    for (int round = 0; round < 12; ++round) {
        CAPTURE(round);
        const auto codes = start_together(path, false);
        const auto winners = std::ranges::count(codes, recorded);
        CHECK(winners >= 1);
        CHECK(winners + std::ranges::count(codes, refused) == programs);
        all += winners;
        check_script(path, script_ticks);
        if (all > 1) check_script(folder / "a.previous.session", script_ticks);
    }
    CHECK_FALSE(std::filesystem::exists(path.string() + ".lock"));
}

TEST_CASE("File lock: a lock that is acquired and released repeatedly is never held twice") {
    struct Shared {
        std::atomic<int> holders = 0;
        std::atomic<int> ready = 0;
    };
    static_assert(std::atomic<int>::is_always_lock_free);
    const Folder folder;
    const auto path = folder / "a.session";
    void* const memory =
        ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    REQUIRE(memory != MAP_FAILED);
    auto* const shared = new (memory) Shared;
    std::array<pid_t, programs> children{};
    (void)std::fflush(nullptr);
    for (pid_t& child : children) {
        child = ::fork();
        if (child < 0) std::abort();
        if (child != 0) continue;
        ::alarm(time_limit_s);
        for (++shared->ready; shared->ready < static_cast<int>(programs);) ::sched_yield();
        for (int holds = 0; holds < 500;) {
            const auto lock = FileLock::acquire(path, path.string());
            if (!lock) {
                if (exit_status(lock.error(), path) == failed) ::_exit(failed);
                continue;
            }
            if (shared->holders.fetch_add(1) != 0) ::_exit(1);
            ++holds;
            ::sched_yield();
            --shared->holders;
        }
        ::_exit(recorded);
    }
    for (const pid_t child : children) {
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        CHECK((WIFEXITED(status) && WEXITSTATUS(status) == recorded));
    }
    CHECK_FALSE(std::filesystem::exists(path.string() + ".lock"));
    ::munmap(memory, sizeof(Shared));
}

TEST_CASE("File lock: a kill releases the lock") {
    const Folder folder;
    const auto path = folder / "a.session";
    const ChildEnd end = run_child(
        [&](const auto& report) {
            auto writer = create_script(path);
            if (!writer || !play_script(*writer, 15)) return 1;
            report(1);
            ::alarm(time_limit_s);
            for (;;) ::pause();
        },
        1);
    REQUIRE(end.killed);
    CHECK(std::filesystem::exists(path.string() + ".lock"));
    script_session(path, 25);
    check_script(path, 25);
    CHECK_FALSE(std::filesystem::exists(path.string() + ".lock"));
    const auto previous = SessionReader::open(folder / "a.previous.session");
    REQUIRE(previous);
    CHECK(previous->tick_count() == 10);
}

TEST_CASE("File lock: a lock lasts as long as its writer, also after moves") {
    const Folder folder;
    const auto path = folder / "a.session";
    auto first = create_script(path);
    REQUIRE(first);
    SessionWriter moved = std::move(*first);
    CHECK_FALSE(create_script(path));
    auto other = create_script(folder / "b.session");
    REQUIRE(other);
    SUBCASE("finished") { REQUIRE(moved.finish({})); }
    SUBCASE("replaced by another writer") { moved = std::move(*other); }
    SUBCASE("its lock file is removed") {
        std::filesystem::remove(path.string() + ".lock");
        const auto second = create_script(path);  // SQLite's own locks remain
        REQUIRE_FALSE(second);
        CHECK(second.error().what.find("open elsewhere") != std::string::npos);
        REQUIRE(moved.finish({}));
    }
    CHECK(create_script(path));
}

TEST_CASE("File lock: a foreign file with the name of the lock is not touched") {
    const Folder folder;
    const auto path = folder / "a.session";
    const auto lock = folder / "a.session.lock";
    const auto refusal = [&] {
        const auto writer = create_script(path);
        REQUIRE_FALSE(writer);
        CHECK(writer.error().file == path.string());
        CHECK(writer.error().what.find(lock.string()) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(path));
        return writer.error().what;
    };
    SUBCASE("with content") {
        put_bytes(lock, "mine");
        CHECK(refusal() == lock.string() + " is not a lock file");
        CHECK(bytes_of(lock) == "mine");
    }
    SUBCASE("a folder") {
        std::filesystem::create_directory(lock);
        CHECK(refusal().find("Is a directory") != std::string::npos);
        CHECK(std::filesystem::is_directory(lock));
    }
    SUBCASE("a link") {
        put_bytes(folder / "far", "");
        std::filesystem::create_symlink(folder / "far", lock);
        CHECK(refusal().find("symbolic links") != std::string::npos);
        CHECK(std::filesystem::exists(folder / "far"));
    }
}

}  // namespace session_file_lock_test
