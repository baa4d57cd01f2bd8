#include "engine/base/process.hpp"

#include <doctest/doctest.h>

using namespace bolt;

TEST_CASE("a program is run to its end: what it said, to whom, and how it ended") {
    const auto run = run_program({"sh", "-c", "echo one; echo two >&2; exit 3"}, Hear::output_and_errors);
    REQUIRE(run.has_value());
    CHECK(run->exit_code == 3);
    CHECK(run->said == "one\ntwo\n");
    const auto quiet = run_program({"sh", "-c", "echo one; echo two 1>&2"}, Hear::output);
    REQUIRE(quiet.has_value());
    CHECK(quiet->exit_code == 0);
    CHECK(quiet->said == "one\n");
    // More than a pipe holds.
    const auto much = run_program({"sh", "-c", "head -c 300000 /dev/zero"}, Hear::output);
    REQUIRE(much.has_value());
    CHECK(much->said.size() == 300000);
    CHECK(run_program({"sh", "-c", "kill -9 $$"}, Hear::output)->exit_code == -1);
    const auto none = run_program({"no-such-program-anywhere"}, Hear::output);
    REQUIRE_FALSE(none.has_value());
    CHECK(none.error().what.find("no-such-program-anywhere cannot be started") == 0);
}
