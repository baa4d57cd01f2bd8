#include "tests/support/screen_picture.hpp"

#include <cstdlib>
#include <string>

#include "engine/base/file.hpp"

namespace bolt::test {

Result<ScreenPicture> read_screen() {
    const char* file = std::getenv("BOLT_SCREEN");
    if (file == nullptr) return fail(ErrorCode::failed, "there is no screen", "tests/with_screen.sh");
    constexpr std::size_t most_bytes = std::size_t{64} << 20;  // more than any screen here
    BOLT_TRY_ASSIGN(const std::string xwd, read_file(file, most_bytes, ErrorCode::failed));
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
    // Pointers, because this code is hardly optimised and some tests read the screen every few frames.
    picture.rgba.resize(std::size_t{4} * picture.width * picture.height);
    std::uint8_t* out = picture.rgba.data();
    for (std::size_t y = 0; y < picture.height; ++y) {
        const char* in = xwd.data() + first + y * row;
        for (std::size_t x = 0; x < picture.width; ++x, in += 4, out += 4) {
            out[0] = static_cast<std::uint8_t>(in[2]);
            out[1] = static_cast<std::uint8_t>(in[1]);
            out[2] = static_cast<std::uint8_t>(in[0]);
            out[3] = 255;
        }
    }
    return picture;
}

}  // namespace bolt::test
