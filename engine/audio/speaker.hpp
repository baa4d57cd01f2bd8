// Sound output on its own thread, which requests samples whenever the device has room, so that slow frames
// cause no gaps. Without a device it is silent and reports the reason.
#pragma once

#include <optional>

#include "engine/audio/feeder.hpp"

namespace bolt::audio {

class Speaker {
  public:
    // Returns at once; the thread opens the device and reopens it after a loss. Only that thread calls
    // `fill`, block by block; `fill` must not throw or block.
    static Result<Speaker> start(Fill fill);
    static Result<Speaker> start(Fill fill, OpenSink open);

    Speaker(Speaker&&) noexcept;
    Speaker& operator=(Speaker&&) noexcept;
    ~Speaker();  // stops the thread

    void set_volume(double volume);  // 0 … 1; thread-safe

    // The most recent status. For one calling thread, which also calls status_change().
    const PlaybackStatus& status();

    // Returns a line for the user once after every change: that sound plays (again), or why there is none.
    std::optional<std::string> status_change();

  private:
    struct Shared;
    explicit Speaker(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::audio
