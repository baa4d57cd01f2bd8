// A part of a test's screen as PNG: test_screenshot FILE.png X Y WIDTH HEIGHT
#include <cstdlib>
#include <span>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "tests/support/screen_picture.hpp"

namespace {

bolt::Status take(const char* file, unsigned x, unsigned y, unsigned width, unsigned height) {
    const auto screen = bolt::test::read_screen();
    if (!screen) return bolt::fail(screen.error());
    if (x + width > screen->width || y + height > screen->height)
        return bolt::fail(bolt::ErrorCode::usage, "that is not all on the screen", "a part of the screen");
    std::vector<std::uint8_t> rgb;
    for (unsigned row = y; row < y + height; ++row)
        for (unsigned column = x; column < x + width; ++column)
            for (const int value : screen->at(column, row)) rgb.push_back(static_cast<std::uint8_t>(value));
    const auto png = bolt::assets::encode_png(static_cast<int>(width), static_cast<int>(height), 3, rgb);
    if (!png) return bolt::fail(png.error());
    return bolt::write_file(file, *png);
}

}  // namespace

int main(int argc, char** argv) {
    const std::span<char*> words(argv, static_cast<std::size_t>(argc));
    if (words.size() != 6) return 2;
    const auto number = [&](std::size_t i) {
        return static_cast<unsigned>(std::strtoul(words[i], nullptr, 10));
    };
    const bolt::Status taken = take(words[1], number(2), number(3), number(4), number(5));
    return taken ? 0 : bolt::print_error(taken.error());
}
