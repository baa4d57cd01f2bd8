// Feeds samples to a sound device: opens the sink, keeps it filled, and reopens it after a loss. Without a
// device the program stays silent and continues. The time is a parameter, so that tests control it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/audio/sink.hpp"

namespace bolt::audio {

// Provides the next samples. Called only by Feeder and Speaker.
using Fill = std::function<void(std::span<float>)>;

struct PlaybackStatus {
    bool playing = false;
    std::string device;   // the last one that was opened
    std::string problem;  // why there is no sound; empty while playing
    std::uint64_t openings = 0, losses = 0, blocks = 0;
};

// The pause between attempts to open a sink, s. A failed attempt doubles it: a device that returns is found
// soon, and a missing one costs almost nothing.
inline constexpr double first_pause = 1.0, longest_pause = 64.0;

class Feeder {
  public:
    Feeder(OpenSink open, Fill fill) : open_(std::move(open)), fill_(std::move(fill)) {}

    // Opens the sink if an attempt is due, and fills it. `now` in s, from any epoch.
    void update(double now, double volume);
    void close() { sink_.reset(); }

    [[nodiscard]] const PlaybackStatus& status() const { return status_; }

  private:
    void open(double now);
    Status feed(double volume);
    void lose(double now, const Error& why);

    OpenSink open_;
    Fill fill_;
    std::unique_ptr<Sink> sink_;
    PlaybackStatus status_;
    double next_attempt_ = 0.0, pause_ = first_pause;
    double volume_ = -1.0;  // the sink's volume
    bool tried_ = false;
};

// Sound output on its own thread, which requests samples whenever the device has room, so that slow frames
// cause no gaps. Without a device it is silent and reports the reason.

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
