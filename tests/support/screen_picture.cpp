#include "tests/support/screen_picture.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace bolt::test {

Result<ScreenPicture> read_screen() {
    const char* file = std::getenv("BOLT_SCREEN");
    if (file == nullptr) return fail(ErrorCode::failed, "there is no screen", "tests/with_screen.sh");
    std::ifstream stream(file, std::ios::binary);
    const std::string xwd((std::istreambuf_iterator<char>(stream)), {});
    if (xwd.size() < 100) return fail(ErrorCode::failed, std::string(file) + " is no picture", "one");
    // X11/XWDFile.h: 32-bit numbers, most significant byte first; then a colour table, then the rows.
    const auto number = [&](std::size_t index) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value = value << 8 | static_cast<unsigned char>(xwd[4 * index + i]);
        return std::size_t{value};
    };
    const std::size_t bits_a_pixel = number(11), highest_byte_first = number(7);
    if (bits_a_pixel != 32 || highest_byte_first != 0)
        return fail(ErrorCode::failed, std::string(file) + " is of another kind", "32 bits a pixel");
    ScreenPicture picture{static_cast<std::uint32_t>(number(4)), static_cast<std::uint32_t>(number(5)), {}};
    const std::size_t first = number(0) + 12 * number(19), row = number(12);
    if (xwd.size() < first + picture.height * row)
        return fail(ErrorCode::failed, std::string(file) + " is cut short", "all pixels");
    for (std::size_t y = 0; y < picture.height; ++y)
        for (std::size_t x = 0; x < picture.width; ++x) {
            const char* p = xwd.data() + first + y * row + 4 * x;
            for (const int channel : {2, 1, 0}) picture.rgba.push_back(static_cast<std::uint8_t>(p[channel]));
            picture.rgba.push_back(255);
        }
    return picture;
}

}  // namespace bolt::test
