#include "engine/xr/headset_search.hpp"

#include <chrono>
#include <thread>
#include <utility>

namespace bolt::xr {

namespace {

// Age, s, from which the next search replaces the kept instance: the user may have chosen another runtime,
// which only a new instance loads.
constexpr double longest_kept = 30.0;
constexpr double stop_timeout = 2.0;  // s, for a runtime that does not answer

}  // namespace

// Keeps the instance if only the headset is missing; any other failure destroys it.
void HeadsetSearch::run(Attempt& attempt) {
    std::unique_ptr<Runtime> runtime;
    {
        const std::lock_guard lock(attempt.mutex);
        runtime = std::move(attempt.runtime);
    }
    Status status;
    if (!runtime) {
        Result<std::unique_ptr<Runtime>> started = Runtime::start();
        if (started)
            runtime = std::move(*started);
        else
            status = fail(started.error());
    }
    if (runtime) status = runtime->find_headset();
    if (!status && runtime && !runtime->lacks_headset()) runtime.reset();
    const std::lock_guard lock(attempt.mutex);
    attempt.runtime = std::move(runtime);
    attempt.status = std::move(status);
    attempt.finished = true;
    attempt.changed.notify_all();
}

void HeadsetSearch::start(double now) {
    if (attempt_) return;
    quiet_loader();
    if (kept_ && now - kept_since_ >= longest_kept) kept_.reset();
    if (!kept_) kept_since_ = now;
    attempt_ = std::make_shared<Attempt>();
    attempt_->runtime = std::move(kept_);
    std::thread([attempt = attempt_] { run(*attempt); }).detach();
}

std::optional<Result<std::unique_ptr<Runtime>>> HeadsetSearch::take(double timeout) {
    if (!attempt_) return std::nullopt;
    {
        std::unique_lock lock(attempt_->mutex);
        if (!attempt_->changed.wait_for(lock, std::chrono::duration<double>(timeout),
                                        [&] { return attempt_->finished; }))
            return std::nullopt;
    }
    const std::shared_ptr<Attempt> attempt = std::exchange(attempt_, nullptr);
    if (attempt->status) return Result<std::unique_ptr<Runtime>>(std::move(attempt->runtime));
    kept_ = std::move(attempt->runtime);
    return Result<std::unique_ptr<Runtime>>(fail(attempt->status.error()));
}

void HeadsetSearch::stop() {
    if (attempt_) (void)take(stop_timeout);
    attempt_.reset();
    kept_.reset();
}

}  // namespace bolt::xr
