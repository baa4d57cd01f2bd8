// A CyberGlove without a hand in it: answers and streams as the real one does, and as badly as is wished.
// Pure: bytes and time in, bytes out; glove_line.hpp puts it on a pseudo-terminal.
#pragma once

#include <vector>

#include "engine/base/random.hpp"
#include "haptics/glove/calibration.hpp"
#include "haptics/glove/greeting.hpp"
#include "haptics/hand/angles.hpp"

namespace bolt::emulate {

// Shares of the bytes sent that something happens to.
struct LineFaults {
    double dropped = 0.0, changed = 0.0, added = 0.0;
};

struct GloveDesign {
    std::size_t sensors = 18;
    glove::Hand hand = glove::Hand::right;
    std::string version = "1.2";
    bool plugged = true;
    bool status = false, time = false;  // as it was left by who used it last
    bool streaming = false;             // the same
    bool old_firmware = false;          // answers only to what it must
    LineFaults faults{};
    std::uint64_t seed = 1;
};

// What its sensors give while the hand in it holds a posture: 50 counts flat, and 0.013 rad a count.
glove::BySensor<std::uint8_t> raw_in(glove::Posture posture);
constexpr glove::Line sensor_line{0.013, 50.0};

// What sensors give while the hand is bent like this: 1 … 255 each.
glove::BySensor<std::uint8_t> raw_at(const hand::Angles& hand, const glove::BySensor<glove::Line>& lines);
glove::BySensor<std::uint8_t> raw_at(const hand::Angles& hand, const glove::Line& all = sensor_line);

class Glove {
  public:
    explicit Glove(const GloveDesign& design);

    // What the hand in it does; 1 … 255 each.
    glove::BySensor<std::uint8_t> raw{};
    bool stalled = false;  // sends nothing and hears nothing

    // What came in since the last call, and the time now, s. What goes out.
    std::vector<std::uint8_t> go_on(std::span<const std::uint8_t> received, double now);

    [[nodiscard]] bool streaming() const { return streaming_; }
    [[nodiscard]] double rate() const { return rate_; }
    [[nodiscard]] std::uint64_t sent() const { return sent_; }  // frames

  private:
    using Bytes = std::vector<std::uint8_t>;
    void hear(std::uint8_t byte, Bytes& out);
    bool answer(Bytes& out);
    void frame(std::uint8_t letter, Bytes& out) const;
    [[nodiscard]] Bytes spoiled(const Bytes& bytes);

    GloveDesign design_;
    Random random_;
    Bytes heard_;
    bool streaming_, status_, time_;
    std::size_t samples_;
    double rate_ = 80.0, next_ = 0.0;
    std::uint64_t sent_ = 0;
};

}  // namespace bolt::emulate
