#include <doctest/doctest.h>

#include "tests/xr/support.hpp"

using namespace bolt;

TEST_CASE("Headset: a session comes into focus, and frames are submitted") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.headset().runtime().headset() == "Mock headset");
    CHECK(program.focus().focused);
    for (int i = 0; i < 5; ++i) CHECK(program.frame().has_value());
    CHECK(mock->take_frames().size() > 5);
    program.disconnect();
    CHECK(mock->instance() == XR_NULL_HANDLE);
}
