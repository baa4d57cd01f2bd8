// Sound output. Feeder opens a sink, keeps it filled, and reopens it after a loss; Speaker does this on a
// thread of its own. Without a device the program continues silently.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "engine/audio/sink.hpp"

namespace bolt::audio {

// Fills a block with the next samples. Called only by Feeder and Speaker.
using FillSamples = std::function<void(std::span<float>)>;

struct PlaybackStatus {
    bool playing = false;
    std::string device;   // name of the last device that was opened
    std::string problem;  // why there is no sound; empty while playing
    std::uint64_t openings = 0, losses = 0, blocks = 0;
};

// The pause between attempts to open a sink, s. A failed attempt doubles it: a device that returns soon is
// found soon, and a missing one costs almost nothing.
inline constexpr double first_pause = 1.0, max_pause = 64.0;

// Feeds one sink. The time is a parameter, so that tests control it.
class Feeder {
  public:
    Feeder(OpenSink open, FillSamples fill) : open_(std::move(open)), fill_(std::move(fill)) {}

    // Opens the sink if an attempt is due, and fills it. `now`: s, from any epoch. `volume`: 0 … 1.
    void update(double now, double volume);
    void close() { sink_.reset(); }

    [[nodiscard]] const PlaybackStatus& status() const { return status_; }

  private:
    void open(double now);
    Status feed(double volume);
    void handle_loss(double now, const Error& error);

    OpenSink open_;
    FillSamples fill_;
    std::unique_ptr<Sink> sink_;
    PlaybackStatus status_;
    double next_attempt_ = 0.0, pause_ = first_pause;  // s
    double volume_ = -1.0;                             // the sink's volume; -1: not set yet
    bool attempted_ = false;                           // true after the first attempt to open a sink
};

// A Feeder on its own thread. The thread requests samples whenever the device can queue them, so that slow
// frames cause no gaps.
class Speaker {
  public:
    // Returns at once; the thread opens the device and reopens it after a loss. Only that thread calls
    // `fill`, block by block; `fill` must not throw or block.
    static Result<Speaker> start(FillSamples fill);
    static Result<Speaker> start(FillSamples fill, OpenSink open);

    Speaker(Speaker&&) noexcept;
    Speaker& operator=(Speaker&&) noexcept;
    ~Speaker();  // stops the thread

    void set_volume(double volume);  // 0 … 1; thread-safe

    // Returns the most recent status. Only one thread may call status() and status_change().
    const PlaybackStatus& status();

    // Returns a line for the user, at the start and whenever the sound begins or ends: the device that plays,
    // or why there is no sound.
    std::optional<std::string> status_change();

  private:
    struct Shared;
    explicit Speaker(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::audio
