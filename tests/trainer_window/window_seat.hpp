// A place at the trainer's real window: what is done there goes through the X server.
//
// The trainer keeps its thread, the one that the window belongs to; whoever sits here has another. They take
// turns: the one works while the other waits, so what is seen here is the picture that has just been shown.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>

#include "engine/platform/window.hpp"
#include "tests/platform/window_user.hpp"
#include "tests/trainer_app/seat.hpp"

namespace bolt::test {

class WindowSeat final : public Seat {
  public:
    WindowSeat(const trainer::App& app, const platform::Window& window) : app_(app), window_(window) {}

    // For trainer::WindowChoice::stop: whether they have had enough.
    bool turn();
    // What somebody does here from the first picture on, in a thread of theirs; then the window is left.
    void sit(const std::function<void()>& act);
    // There is no window any more: whoever still waits for a picture leaves.
    void gone();

    void frame() override;
    void key(platform::Key key) override;
    void move(const glm::dvec2& to) override;
    void press(const glm::dvec2& at) override;
    void release(const glm::dvec2& at) override;
    [[nodiscard]] const trainer::App& app() const override { return app_; }
    [[nodiscard]] glm::dvec2 size() const override;

  private:
    const trainer::App& app_;
    const platform::Window& window_;
    std::unique_ptr<WindowUser> hand_;
    // A semaphore would do, but that of libstdc++ 12 was seen to sleep on here when it had been released.
    enum class Turn : std::uint8_t { shows, sits };
    void wait_for(Turn turn);
    void pass_to(Turn turn);
    std::mutex mutex_;
    std::condition_variable changed_;
    Turn turn_ = Turn::shows;
    bool left_ = false, gone_ = false;
};

}  // namespace bolt::test
