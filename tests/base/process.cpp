#include "engine/base/process.hpp"

#include <doctest/doctest.h>

#include <csignal>
#include <string>
#include <vector>

using namespace bolt;

TEST_CASE("run_program: captures output and errors, and returns the exit code") {
    const auto run = run_program({"sh", "-c", "echo one; echo two >&2; exit 3"}, Capture::output_and_errors);
    REQUIRE(run.has_value());
    CHECK(run->exit_code == 3);
    CHECK(run->output == "one\ntwo\n");
    const auto quiet = run_program({"sh", "-c", "echo one; echo two 1>&2"}, Capture::output);
    REQUIRE(quiet.has_value());
    CHECK(quiet->exit_code == 0);
    CHECK(quiet->output == "one\n");
    // More than the capacity of a pipe.
    const auto much = run_program({"sh", "-c", "head -c 300000 /dev/zero"}, Capture::output);
    REQUIRE(much.has_value());
    CHECK(much->output.size() == 300000);
    CHECK(run_program({"sh", "-c", "kill -9 $$"}, Capture::output)->exit_code == -1);
    const auto none = run_program({"no-such-program-anywhere"}, Capture::output);
    REQUIRE_FALSE(none.has_value());
    CHECK(none.error().what.find("no-such-program-anywhere cannot be started") == 0);
}

TEST_CASE("ChildStdin: a program receives all bytes, and its exit code is returned") {
    std::vector<std::uint8_t> bytes(300'000, 'x');
    auto child = ChildStdin::start({"sh", "-c", "test $(wc -c) = 300000 && exit 7"});
    REQUIRE(child);
    CHECK(child->write(bytes));
    CHECK(child->finish() == 7);
    CHECK(child->finish() == -1);  // it was finished before
}

TEST_CASE("ChildStdin: a missing program cannot be started, and writing to a program that has ended fails") {
    const auto missing = ChildStdin::start({"no-such-program-of-boltwright"});
    REQUIRE_FALSE(missing);
    CHECK(missing.error().what.find("cannot be started") != std::string::npos);
    const auto before = std::signal(SIGPIPE, SIG_IGN);
    auto child = ChildStdin::start({"true"});
    REQUIRE(child);
    const std::vector<std::uint8_t> bytes(1'000'000, 'x');
    const Status written = child->write(bytes);
    REQUIRE_FALSE(written);
    CHECK(written.error().what.find("no longer reads its input") != std::string::npos);
    CHECK(child->finish() == 0);
    (void)std::signal(SIGPIPE, before);
}
