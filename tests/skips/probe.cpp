// Test cases for skips.sh, which runs them one at a time: each shows one outcome.
#include <doctest/doctest.h>

#include "tests/support/skip.hpp"

using namespace bolt;

TEST_CASE("Probe: checked") { CHECK(true); }
TEST_CASE("Probe: skipped") { return test::skip_rest("no reason at all"); }
TEST_CASE("Probe: skipped in part") {
    CHECK(true);
    test::skip_part("half a reason");
}
TEST_CASE("Probe: skipped in one subcase") {
    SUBCASE("first") { CHECK(true); }
    SUBCASE("second") { return test::skip_rest("a subcase's reason"); }
}
TEST_CASE("Probe: failed and skipped") {
    CHECK(false);
    test::skip_rest("too late");
}
TEST_CASE("Probe: unchecked") {}
