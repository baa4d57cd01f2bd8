// The screen contents of a test's X server, read from Xvfb's file ($BOLT_SCREEN, tests/with_screen.sh).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::test {

struct ScreenPicture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;

    [[nodiscard]] std::array<int, 3> at(std::uint32_t x, std::uint32_t y) const {
        const std::uint8_t* p = rgba.data() + 4 * (std::size_t{y} * width + x);
        return {p[0], p[1], p[2]};
    }
};
Result<ScreenPicture> read_screen();

}  // namespace bolt::test
