#include "tests/trainer_window/window_seat.hpp"

#include <stdexcept>

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

bool WindowSeat::turn() {
    if (left_) return true;
    sits_.release();
    shows_.acquire();
    return left_;
}

void WindowSeat::sit(const std::function<void()>& act) {
    sits_.acquire();
    const auto leave = [&] {
        left_ = true;
        shows_.release();
    };
    try {
        hand_ = std::make_unique<Hand>("boltwright");
        act();
    } catch (...) {
        leave();
        throw;
    }
    leave();
}

void WindowSeat::gone() {
    gone_ = true;
    sits_.release();
}

void WindowSeat::frame() {
    shows_.release();
    sits_.acquire();
    if (gone_) throw std::runtime_error("the window is gone");
}

void WindowSeat::key(platform::Key key) {
    hand_->key(keysym(key).c_str());
    frame();
}

void WindowSeat::move(const glm::dvec2& to) {
    hand_->point(static_cast<int>(to.x), static_cast<int>(to.y));
    frame();
}

void WindowSeat::press(const glm::dvec2& at) {
    move(at);
    hand_->press(static_cast<int>(at.x), static_cast<int>(at.y));
    frame();
}

void WindowSeat::release(const glm::dvec2& at) {
    hand_->release(static_cast<int>(at.x), static_cast<int>(at.y));
    frame();
}

glm::dvec2 WindowSeat::size() const {
    const platform::Size pixels = window_.pixels();
    return {pixels.width, pixels.height};
}

}  // namespace bolt::test
