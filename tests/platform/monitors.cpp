// The list of connected monitors, on the one screen of with_screen.sh.
#include <doctest/doctest.h>

#include "engine/platform/window.hpp"

namespace monitors_test {

using namespace bolt;

TEST_CASE("Monitors: the screen is listed with its name, place and size") {
    const Result<platform::Desktop> desktop = platform::Desktop::open();
    if (!desktop) FAIL(desktop.error().message());
    const std::vector<platform::Monitor> all = platform::monitors(*desktop);
    REQUIRE(all.size() == 1);
    CHECK_FALSE(all[0].name.empty());
    CHECK(all[0].area.x == 0);
    CHECK(all[0].area.y == 0);
    CHECK(all[0].area.width == 1280);
    CHECK(all[0].area.height == 800);
}

}  // namespace monitors_test
