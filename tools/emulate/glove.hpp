// A CyberGlove without a hand in it: answers and streams as the real one does, and as badly as is wished.
// Pure: bytes and time in, bytes out; glove_line.hpp puts it on a pseudo-terminal.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/base/random.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_protocol.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::emulate {

// Shares of the bytes sent that something happens to.
struct ByteFaults {
    double dropped = 0.0, changed = 0.0, added = 0.0;
};

struct GloveOptions {
    std::size_t sensors = 18;
    hand::Side hand = hand::Side::right;
    std::string version = "1.2";
    bool plugged = true;
    bool status = false, time = false;  // as it was left by who used it last
    bool streaming = false;             // the same
    bool old_firmware = false;          // answers only to what it must
    ByteFaults faults{};
    std::uint64_t seed = 1;
};

// What its sensors give while the hand in it holds a posture: 50 counts flat, and 0.013 rad a count.
hand::PerSensor<std::uint8_t> raw_values(hand::Posture posture);
constexpr hand::LinearFit sensor_fit{0.013, 50.0};

// What sensors give while the hand is bent like this: 1 … 255 each.
hand::PerSensor<std::uint8_t> raw_values(const hand::Angles& hand,
                                         const hand::PerSensor<hand::LinearFit>& lines);
hand::PerSensor<std::uint8_t> raw_values(const hand::Angles& hand, const hand::LinearFit& all = sensor_fit);

class Glove {
  public:
    explicit Glove(const GloveOptions& design);

    // What the hand in it does; 1 … 255 each.
    hand::PerSensor<std::uint8_t> raw{};
    bool stalled = false;  // sends nothing and hears nothing

    // What came in since the last call, and the time now, s. What goes out.
    std::vector<std::uint8_t> advance(std::span<const std::uint8_t> received, double now);

    [[nodiscard]] bool streaming() const { return streaming_; }
    [[nodiscard]] double rate() const { return rate_; }
    [[nodiscard]] std::uint64_t sent() const { return sent_; }  // frames

  private:
    using Bytes = std::vector<std::uint8_t>;
    void hear(std::uint8_t byte, Bytes& out);
    bool answer(Bytes& out);
    void frame(std::uint8_t letter, Bytes& out) const;
    [[nodiscard]] Bytes with_faults(const Bytes& bytes);

    GloveOptions design_;
    Random random_;
    Bytes heard_;
    bool streaming_, status_, time_;
    std::size_t samples_;
    double rate_ = 80.0, next_ = 0.0;
    std::uint64_t sent_ = 0;
};

// An emulated glove at one end of a pseudo-terminal; the other end is a port that any driver can open.

class SerialGlove {
  public:
    // A thread plays the glove from now on. The hand in it opens and closes once in `period` seconds; 0: it
    // stays as it is.
    static Result<SerialGlove> start(const GloveOptions& design, double period = 0.0);

    SerialGlove(SerialGlove&&) noexcept;
    SerialGlove& operator=(SerialGlove&&) noexcept;
    ~SerialGlove();  // pulls the plug: the port is gone

    [[nodiscard]] const std::filesystem::path& port() const;
    // What the hand in it does from the next moment on, unless it opens and closes by itself. One thread at a
    // time.
    void show(const hand::PerSensor<std::uint8_t>& raw);
    void stall(bool stalled);  // from the next moment on it neither sends nor hears

  private:
    struct Shared;
    explicit SerialGlove(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::emulate
