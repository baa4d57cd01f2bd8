// Hands at a window of a test's screen.
#pragma once

#include <memory>
#include <string>

namespace bolt::test {

// Somebody who uses the window with this title: sends what the X server would.
class Hand {
  public:
    explicit Hand(const std::string& title);
    ~Hand();
    Hand(const Hand&) = delete;
    Hand& operator=(const Hand&) = delete;

    void key(const char* keysym);  // pressed and let go: "F11", "r", "Escape"
    void move(int x, int y);
    void point(int x, int y);                       // the same with the screen's own pointer, which is seen
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
