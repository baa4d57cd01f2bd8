// What is heard while a program runs: a thread of its own asks for samples whenever the sound device has
// room, so that a slow picture is no gap in the sound. Without a device it is silent and says why.
#pragma once

#include <optional>

#include "engine/audio/feeder.hpp"

namespace bolt::audio {

class Speaker {
  public:
    // Returns at once; the device is opened by the thread, and again when it was lost. `fill` is called by
    // that thread only, block by block; it must neither throw nor wait.
    static Result<Speaker> start(Fill fill);
    static Result<Speaker> start(Fill fill, OpenSink open);

    Speaker(Speaker&&) noexcept;
    Speaker& operator=(Speaker&&) noexcept;
    ~Speaker();  // stops

    void set_volume(double volume);  // 0 … 1; for any caller

    // As it was a moment ago. For one caller, the same as news().
    const Report& report();

    // A line for people, once for every change: that there is no sound and why, that it plays (again).
    std::optional<std::string> news();

  private:
    struct Shared;
    explicit Speaker(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::audio
