// Two threads that take turns: that of a program, and that of a user who sees every frame before acting on
// it.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stdexcept>

namespace bolt::test {

class Turns {
  public:
    // In the program's thread, once a frame: lets the user act. Returns true when the user is done.
    bool give() {
        pass_to(Turn::user);
        wait_for(Turn::program);
        const std::lock_guard lock(mutex_);
        return done_;
    }
    // In the program's thread, when it ends; a waiting take() then throws.
    void end_program() {
        {
            const std::lock_guard lock(mutex_);
            ended_ = true;
        }
        changed_.notify_all();
    }

    // In the user's thread: runs `act` from the first turn on.
    void run(const std::function<void()>& act) {
        const auto leave = [&] {
            {
                const std::lock_guard lock(mutex_);
                done_ = true;
            }
            changed_.notify_all();
        };
        try {
            wait_for(Turn::user);
            act();
        } catch (...) {
            leave();
            throw;
        }
        leave();
    }
    // In the user's thread: lets the program run its next frame.
    void take() {
        pass_to(Turn::program);
        wait_for(Turn::user);
        const std::lock_guard lock(mutex_);
        if (ended_) throw std::runtime_error("the program has ended");
    }

  private:
    // Not a semaphore: std::counting_semaphore of libstdc++ 12 was observed not to wake up after a release.
    enum class Turn : std::uint8_t { program, user };
    void wait_for(Turn turn) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return turn_ == turn || done_ || ended_; });
    }
    void pass_to(Turn turn) {
        {
            const std::lock_guard lock(mutex_);
            turn_ = turn;
        }
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    Turn turn_ = Turn::program;
    bool done_ = false, ended_ = false;
};

}  // namespace bolt::test
