// A simulated user of a window on the test's X server.
#pragma once

#include <memory>
#include <string>

namespace bolt::test {

// Sends X events to the window with this title.
class WindowUser {
  public:
    explicit WindowUser(const std::string& title);
    ~WindowUser();
    WindowUser(const WindowUser&) = delete;
    WindowUser& operator=(const WindowUser&) = delete;

    void key(const char* keysym);  // press and release: "F11", "r", "Escape"
    void move(int x, int y);
    void point(int x, int y);                       // moves the real, visible pointer
    void press(int x, int y, unsigned button = 1);  // 1 left, 2 middle, 3 right; 4 and 5 are the wheel
    void release(int x, int y, unsigned button = 1);
    void close();  // the window manager's close request

    struct WindowRectangle {
        int x = 0, y = 0, width = 0, height = 0;
    };
    [[nodiscard]] WindowRectangle rectangle() const;  // on the screen, pixels

  private:
    struct X;
    std::unique_ptr<X> x_;
};

// The text size that the desktop announces while this exists: `scale` times the usual one. A Desktop reads it
// when it opens.
class DesktopScale {
  public:
    explicit DesktopScale(int scale);
    ~DesktopScale();
    DesktopScale(const DesktopScale&) = delete;
    DesktopScale& operator=(const DesktopScale&) = delete;
};

}  // namespace bolt::test
