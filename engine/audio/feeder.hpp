// Samples on their way to a sink: it is opened, fed as fast as it takes them, and opened again when it is
// lost. Without one there is silence and a reason, and the program goes on. Pure but for its sink: it is told
// the time.
#pragma once

#include <cstdint>
#include <span>

#include "engine/audio/sink.hpp"

namespace bolt::audio {

// Gives the next samples; called only where feeder or speaker says.
using Fill = std::function<void(std::span<float>)>;

struct Report {
    bool playing = false;
    std::string device;   // the newest that was opened
    std::string trouble;  // why nothing is heard; empty while playing
    std::uint64_t openings = 0, losses = 0, blocks = 0;
};

// Between attempts to open a sink, s: a card that comes back is soon heard, and one that never does costs
// nothing. Each attempt that fails doubles the pause.
inline constexpr double first_pause = 1.0, longest_pause = 64.0;

class Feeder {
  public:
    Feeder(OpenSink open, Fill fill) : open_(std::move(open)), fill_(std::move(fill)) {}

    // Opens if it is time to, and gives the sink what it has room for. `now` in s, from any beginning.
    void turn(double now, double volume);
    void close() { sink_.reset(); }

    [[nodiscard]] const Report& report() const { return report_; }

  private:
    void open(double now);
    Status feed(double volume);
    void lose(double now, const Error& why);

    OpenSink open_;
    Fill fill_;
    std::unique_ptr<Sink> sink_;
    Report report_;
    double next_attempt_ = 0.0, pause_ = first_pause;
    double volume_ = -1.0;  // that the sink has
    bool tried_ = false;
};

}  // namespace bolt::audio
