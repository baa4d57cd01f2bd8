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

void WindowSeat::wait_for(Turn turn) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return turn_ == turn || left_ || gone_; });
}

void WindowSeat::pass_to(Turn turn) {
    {
        const std::lock_guard lock(mutex_);
        turn_ = turn;
    }
    changed_.notify_all();
}

bool WindowSeat::turn() {
    pass_to(Turn::sits);
    wait_for(Turn::shows);
    const std::lock_guard lock(mutex_);
    return left_;
}

void WindowSeat::sit(const std::function<void()>& act) {
    const auto leave = [&] {
        {
            const std::lock_guard lock(mutex_);
            left_ = true;
        }
        changed_.notify_all();
    };
    try {
        wait_for(Turn::sits);
        hand_ = std::make_unique<WindowUser>("boltwright");
        act();
    } catch (...) {
        leave();
        throw;
    }
    leave();
}

void WindowSeat::gone() {
    {
        const std::lock_guard lock(mutex_);
        gone_ = true;
    }
    changed_.notify_all();
}

void WindowSeat::frame() {
    pass_to(Turn::shows);
    wait_for(Turn::sits);
    const std::lock_guard lock(mutex_);
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
