#include "tests/trainer_window/window_driver.hpp"

#include <cstdlib>

namespace bolt::test {

namespace {

std::string keysym(platform::Key key) {
    switch (key) {
        case platform::Key::escape:
            return "Escape";
        case platform::Key::enter:
            return "Return";
        case platform::Key::backspace:
            return "BackSpace";
        default:
            return std::string(platform::name(key));
    }
}

}  // namespace

void WindowDriver::run(const std::function<void()>& act) {
    turns_.run([&] {
        hand_ = std::make_unique<WindowUser>("boltwright");
        act();
    });
}

void WindowDriver::key(platform::Key key) {
    hand_->key(keysym(key).c_str());
    frame();
}

void WindowDriver::move(const glm::dvec2& to) {
    hand_->point(static_cast<int>(to.x), static_cast<int>(to.y));
    frame();
}

void WindowDriver::press(const glm::dvec2& at) {
    move(at);
    hand_->press(static_cast<int>(at.x), static_cast<int>(at.y));
    frame();
}

void WindowDriver::release(const glm::dvec2& at) {
    hand_->release(static_cast<int>(at.x), static_cast<int>(at.y));
    frame();
}

void WindowDriver::turn_button(const glm::dvec2& at, bool down) {
    const int x = static_cast<int>(at.x), y = static_cast<int>(at.y);
    if (down)
        hand_->press(x, y, 3);
    else
        hand_->release(x, y, 3);
    frame();
}

void WindowDriver::drag(const glm::dvec2& to, int notches) {
    const int x = static_cast<int>(to.x), y = static_cast<int>(to.y);
    hand_->point(x, y);
    for (int i = 0; i < std::abs(notches); ++i) {
        hand_->press(x, y, notches > 0 ? 4 : 5);
        hand_->release(x, y, notches > 0 ? 4 : 5);
    }
    frame();
}

glm::dvec2 WindowDriver::size() const {
    const platform::Size pixels = window_.pixels();
    return {pixels.width, pixels.height};
}

}  // namespace bolt::test
