// An emulated CyberGlove with optional faults: the protocol without I/O, and a glove that runs on a
// pseudo-terminal.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "engine/base/random.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_protocol.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::emulate {

// Probabilities of faults in each byte that the glove sends.
struct ByteFaults {
    double dropped = 0.0, changed = 0.0, added = 0.0;
};

struct EmulatedGloveOptions {
    std::size_t sensors = 18;
    hand::Side hand = hand::Side::right;
    std::string version = "1.2";
    bool plugged = true;
    // Settings that the previous program left in the glove: if a frame contains the status byte, if it
    // contains the time, and if the glove sends frames without a request.
    bool status = false, time = false;
    bool streaming = false;
    bool old_firmware = false;  // rejects the optional commands
    ByteFaults faults{};
    std::uint64_t seed = 1;
};

// Returns the sensor values of a hand in a posture: 50 counts when flat, 0.013 rad per count.
hand::PerSensor<std::uint8_t> raw_values(hand::Posture posture);
constexpr hand::LinearFit sensor_fit{0.013, 50.0};

// Returns the sensor values, 1 … 255, at these angles of the finger joints. The other sensors are at rest.
hand::PerSensor<std::uint8_t> raw_values(const hand::Angles& hand,
                                         const hand::PerSensor<hand::LinearFit>& fits);
hand::PerSensor<std::uint8_t> raw_values(const hand::Angles& hand, const hand::LinearFit& all = sensor_fit);

// The protocol of a CyberGlove without I/O: bytes and time in, bytes out.
class EmulatedGlove {
  public:
    explicit EmulatedGlove(const EmulatedGloveOptions& options);

    hand::PerSensor<std::uint8_t> raw{};  // sensor values, 1 … 255
    bool stalled = false;                 // neither sends nor receives

    // Takes the bytes received since the last call and the time (s). Returns the bytes to send.
    std::vector<std::uint8_t> advance(std::span<const std::uint8_t> received, double now);

    [[nodiscard]] bool streaming() const { return streaming_; }
    [[nodiscard]] double rate() const { return rate_; }
    [[nodiscard]] std::uint64_t sent() const { return sent_; }  // frames

  private:
    using Bytes = std::vector<std::uint8_t>;
    void receive(std::uint8_t byte, Bytes& out);
    bool answer_command(Bytes& out);
    void append_frame(std::uint8_t letter, Bytes& out) const;
    [[nodiscard]] Bytes with_faults(const Bytes& bytes);

    EmulatedGloveOptions options_;
    Random random_;
    Bytes received_;
    bool streaming_, status_, time_;
    std::size_t samples_;
    double rate_ = 80.0, next_ = 0.0;
    std::uint64_t sent_ = 0;
};

// An emulated glove at one end of a pseudo-terminal. The other end is a port that any driver can open.
class SerialGlove {
  public:
    // Starts a thread that runs the glove. The hand opens and closes with `period` (s); 0: no motion.
    static Result<SerialGlove> start(const EmulatedGloveOptions& options, double period = 0.0);

    SerialGlove(SerialGlove&&) noexcept;
    SerialGlove& operator=(SerialGlove&&) noexcept;
    ~SerialGlove();  // closes the pseudo-terminal: the port disappears

    [[nodiscard]] const std::filesystem::path& port() const;
    // Sets the sensor values. They are overwritten if the glove has a period. Call from one thread at a time.
    void set_raw(const hand::PerSensor<std::uint8_t>& raw);
    void stall(bool stalled);  // stops or resumes sending and receiving

  private:
    struct Shared;
    explicit SerialGlove(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::emulate
