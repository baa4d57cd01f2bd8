// The screen that a test runs on: what it shows, and hands that use it. Tests run under tests/with_screen.sh.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace bolt::test {

// What the X server shows, read from where Xvfb keeps it.
struct ScreenPicture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;

    [[nodiscard]] std::array<int, 3> at(std::uint32_t x, std::uint32_t y) const {
        const std::uint8_t* p = rgba.data() + 4 * (std::size_t{y} * width + x);
        return {p[0], p[1], p[2]};
    }
};
ScreenPicture look_at_screen();

// Somebody who uses the window with this title: sends what the X server would.
class Hand {
  public:
    explicit Hand(const std::string& title);
    ~Hand();
    Hand(const Hand&) = delete;
    Hand& operator=(const Hand&) = delete;

    void key(const char* keysym);  // pressed and let go: "F11", "r", "Escape"
    void move(int x, int y);
    void press(int x, int y, unsigned button = 1);  // 1 left, 2 middle, 3 right; 4 and 5 turn the wheel
    void release(int x, int y, unsigned button = 1);
    void close();  // as the window manager asks for it

    struct Place {
        int x = 0, y = 0, width = 0, height = 0;
    };
    [[nodiscard]] Place place() const;  // on the screen, pixels

  private:
    struct X;
    std::unique_ptr<X> x_;
};

}  // namespace bolt::test
