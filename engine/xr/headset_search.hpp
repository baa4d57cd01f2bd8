// The search for a headset, on a thread of its own: a runtime may take seconds to start, or hang.
#pragma once

#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>

#include "engine/xr/runtime.hpp"

namespace bolt::xr {

// One search at a time. The thread shares the ownership of what it writes, so it may outlive the search if
// the runtime never returns.
class HeadsetSearch {
  public:
    HeadsetSearch() = default;
    HeadsetSearch(const HeadsetSearch&) = delete;
    HeadsetSearch& operator=(const HeadsetSearch&) = delete;
    ~HeadsetSearch() { stop(); }

    // Starts a search, if none runs.
    void start(double now);
    [[nodiscard]] bool runs() const { return attempt_ != nullptr; }
    // Returns the result of the search, once; nullopt if the search has not ended after `timeout` s, or if
    // none runs.
    std::optional<Result<std::unique_ptr<Runtime>>> take(double timeout);
    // Ends the search and destroys the instance that it keeps.
    void stop();

  private:
    struct Attempt {
        std::mutex mutex;
        std::condition_variable changed;
        std::unique_ptr<Runtime> runtime;  // also one that has no headset
        Status status;
        bool finished = false;
    };
    static void run(Attempt& attempt);

    std::shared_ptr<Attempt> attempt_;
    std::unique_ptr<Runtime> kept_;  // had no headset; for the next search
    double kept_since_ = 0.0;
};

}  // namespace bolt::xr
