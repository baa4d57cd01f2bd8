#include "engine/base/process.hpp"

#include <doctest/doctest.h>

#include <array>
#include <csignal>
#include <span>
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

namespace {

std::string text_of(std::span<const std::byte> packet) {
    std::string text;
    for (const std::byte b : packet) text += static_cast<char>(b);
    return text;
}

// Starts a shell that runs `script`, with the socket as its standard input.
ChildSocket shell(const std::string& script) {
    auto child = ChildSocket::start({"sh", "-c", script});
    REQUIRE(child);
    return std::move(*child);
}

}  // namespace

TEST_CASE("ChildSocket: exchanges packets with a program, and returns how it exits") {
    ChildSocket child = shell("dd bs=16 count=1 >&0 2>/dev/null; exit 5");
    std::array<std::byte, 16> packet{};
    CHECK_FALSE(*child.receive(packet, 0.01));  // nothing was sent yet
    const std::string sent = "to and fro";
    REQUIRE(child.send(std::as_bytes(std::span(sent))));
    const auto length = child.receive(packet, 60.0);
    REQUIRE(length);
    REQUIRE(*length == sent.size());
    CHECK(text_of(packet).substr(0, sent.size()) == sent);
    const auto ended = child.receive(packet, 60.0);
    REQUIRE_FALSE(ended);
    CHECK(ended.error().what == "sh has ended");
    CHECK_FALSE(child.send(std::as_bytes(std::span(sent))));  // raises no SIGPIPE
    for (int i = 0; i < 2; ++i) {
        const ProgramEnd end = child.end(60.0);
        CHECK(end.exit_code == 5);
        CHECK(end.signal == 0);
        CHECK_FALSE(end.killed);
    }
}

TEST_CASE("ChildSocket: a packet that does not fit is longer than its buffer") {
    ChildSocket child = shell("head -c 9 /dev/zero >&0");
    std::array<std::byte, 4> small{};
    const auto length = child.receive(small, 60.0);
    REQUIRE(length);
    CHECK(*length > small.size());
}

TEST_CASE("ChildSocket: the signal that ends a program is returned, and a program that stays is killed") {
    ChildSocket crashing = shell("kill -SEGV $$");
    const ProgramEnd crash = crashing.end(60.0);
    CHECK(crash.signal == SIGSEGV);
    CHECK_FALSE(crash.killed);
    ChildSocket staying = shell("exec sleep 1000");
    CHECK(staying.end(0.01).killed);
    const auto missing = ChildSocket::start({"no-such-program-of-boltwright"});
    REQUIRE_FALSE(missing);
    CHECK(missing.error().what.find("cannot be started") != std::string::npos);
}
