// A driver for the trainer in a real window, with input through the X server.
//
// The trainer runs in the thread that owns the window, the simulated user in another. They take turns, so the
// user always sees the picture that was shown last.
#pragma once

#include <functional>

#include "engine/platform/window.hpp"
#include "tests/platform/window_user.hpp"
#include "tests/support/turns.hpp"
#include "tests/trainer_app/trainer_driver.hpp"

namespace bolt::test {

class WindowDriver final : public TrainerDriver {
  public:
    WindowDriver(const trainer::App& app, const platform::Window& window) : app_(app), window_(window) {}

    // Call once a frame in the trainer's thread. Returns true when the user is done.
    bool turn() { return turns_.give(); }
    // Runs `act` in the user's thread from the first picture on.
    void run(const std::function<void()>& act);
    // Call when the window is closed; a waiting frame() then throws.
    void window_closed() { turns_.end_program(); }

    void frame() override { turns_.take(); }
    void key(platform::Key key) override;
    void move(const glm::dvec2& to) override;
    void press(const glm::dvec2& at) override;
    void release(const glm::dvec2& at) override;
    void turn_button(const glm::dvec2& at, bool down) override;
    void drag(const glm::dvec2& to, int notches) override;
    [[nodiscard]] const trainer::App& app() const override { return app_; }
    [[nodiscard]] glm::dvec2 size() const override;

  private:
    const trainer::App& app_;
    const platform::Window& window_;
    std::unique_ptr<WindowUser> hand_;
    Turns turns_;
};

}  // namespace bolt::test
