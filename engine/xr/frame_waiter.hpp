// The thread that waits for the runtime's frames.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "engine/xr/openxr.hpp"

namespace bolt::xr {

// Calls xrWaitFrame on its own thread, once for every request. The thread shares the ownership of this
// object, so both may outlive the session if the runtime never returns.
class FrameWaiter {
  public:
    static std::shared_ptr<FrameWaiter> start(XrSession session) {
        auto waiter = std::make_shared<FrameWaiter>();
        std::thread([waiter, session] { waiter->run(session); }).detach();
        return waiter;
    }

    void request() {
        const std::lock_guard lock(mutex_);
        phase_ = Phase::waiting;
        changed_.notify_all();
    }

    struct Answer {
        XrResult result = XR_SUCCESS;
        XrFrameState state{XR_TYPE_FRAME_STATE};
    };
    // The answer to the last request; only one call returns it. None after `timeout` s or without a request.
    std::optional<Answer> take(double timeout) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, std::chrono::duration<double>(timeout),
                          [&] { return phase_ != Phase::waiting; });
        if (phase_ != Phase::answered) return std::nullopt;
        phase_ = Phase::idle;
        return answer_;
    }

    // Discards the answer to the last request. Returns false if a request is unanswered after `timeout` s.
    bool discard_answer(double timeout) {
        (void)take(timeout);
        const std::lock_guard lock(mutex_);
        return phase_ != Phase::waiting;
    }

    // Ends the thread. Returns false if it is still in the runtime after the timeout.
    bool stop(double timeout) {
        std::unique_lock lock(mutex_);
        stopping_ = true;
        changed_.notify_all();
        return changed_.wait_for(lock, std::chrono::duration<double>(timeout), [&] { return finished_; });
    }

  private:
    enum class Phase : std::uint8_t { idle, waiting, answered };

    void run(XrSession session) {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [&] { return stopping_ || phase_ == Phase::waiting; });
            if (stopping_) break;
            lock.unlock();
            Answer answer;
            const XrFrameWaitInfo info{XR_TYPE_FRAME_WAIT_INFO, nullptr};
            answer.result = xrWaitFrame(session, &info, &answer.state);
            lock.lock();
            answer_ = answer;
            phase_ = Phase::answered;
            changed_.notify_all();
        }
        finished_ = true;
        changed_.notify_all();
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    Phase phase_ = Phase::idle;
    Answer answer_;
    bool stopping_ = false, finished_ = false;
};

}  // namespace bolt::xr
