// Starts a lesson on a thread of its own, so that the window shows what an arm needs and takes the user's
// keys while the arm is opened.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "game/trainer/lesson_start.hpp"

namespace bolt::trainer {

class LessonStarter {
  public:
    // Starts the thread. `before`: an earlier start that was given up and may still hold the devices; the
    // thread waits for its end first.
    explicit LessonStarter(LessonStart start, std::unique_ptr<LessonStarter> before = {});
    LessonStarter(const LessonStarter&) = delete;
    LessonStarter& operator=(const LessonStarter&) = delete;
    // Gives up and waits for the thread: until the arm stands still, if it moves by itself.
    ~LessonStarter();

    // The result, once, when it is there.
    std::optional<Result<StartedLesson>> take();

    [[nodiscard]] device::ArmNeeds needs() const;
    void permit_move();  // the arm may move by itself in its next attempt
    void give_up();      // the devices are released as soon as possible

  private:
    bool show(const device::Preparation& preparation);

    std::unique_ptr<LessonStarter> before_;
    std::shared_ptr<device::MovePermission> permission_ = std::make_shared<device::MovePermission>();
    std::atomic<bool> given_up_ = false, done_ = false;
    mutable std::mutex mutex_;
    device::Preparation preparation_;              // under the mutex
    std::optional<Result<StartedLesson>> result_;  // of the thread until done_
    std::jthread thread_;                          // last, so that it ends before the other members
};

}  // namespace bolt::trainer
