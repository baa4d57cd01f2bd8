// The protocol of a CyberGlove: its sensors, frames, handshake and session. Pure: bytes and time in, bytes
// and frames out; glove_driver.hpp adds the port and the thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/function_ref.hpp"
#include "engine/base/result.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {

// The bend sensors in the order of a glove with 22 sensors. MPJ: knuckle; PIJ, DIJ: the next joints; IJ: the
// thumb's last joint. Source: Kessler, Hodges and Walker, "Evaluation of the CyberGlove as a whole-hand input
// device", ACM TOCHI 2(4), 1995.
enum class Sensor : std::uint8_t {
    thumb_roll,  // rotation of the thumb across the palm
    thumb_mpj,
    thumb_ij,
    thumb_abduction,  // thumb to index
    index_mpj,
    index_pij,
    index_dij,
    middle_mpj,
    middle_pij,
    middle_dij,
    middle_abduction,  // index to middle
    ring_mpj,
    ring_pij,
    ring_dij,
    ring_abduction,  // middle to ring
    little_mpj,
    little_pij,
    little_dij,
    little_abduction,  // ring to little
    palm_arch,
    wrist_pitch,
    wrist_yaw,
};
inline constexpr std::size_t sensor_count = 22;

// One value per Sensor.
template <class T>
using PerSensor = std::array<T, sensor_count>;

constexpr std::size_t index(Sensor sensor) { return static_cast<std::size_t>(sensor); }

constexpr bool is_dij(Sensor s) {
    return s == Sensor::index_dij || s == Sensor::middle_dij || s == Sensor::ring_dij ||
           s == Sensor::little_dij;
}

// The sensors of a glove with `count` sensors, in the order of its samples; empty unless `count` is 18 or 22.
// A glove with 18 lacks the four DIJ.
std::span<const Sensor> sensors_of(std::size_t count);

const char* name_of(Sensor sensor);

// A frame is a letter ('S' when streaming, 'G' when polled), one byte 1 … 255 per sensor, five bytes of time
// and one of status if enabled, 'e' and a letter if the glove reports an error, and a zero. In frames
// without time and status only the last byte is zero, so incomplete frames are detected and the reader
// resynchronises at the next zero.

struct GloveFrameLayout {
    std::size_t sensors = 18;  // 18 or 22
    bool time = false, status = false;
};

struct GloveFrame {
    PerSensor<std::uint8_t> raw{};  // 1 … 255; 0: the glove has no such sensor
    std::uint8_t status = 0;        // valid if the layout has it
    bool too_slow = false;          // "es": the sample rate exceeds the line's capacity
    bool unplugged = false;         // "eg": the glove is not connected to its interface unit
};

inline constexpr std::size_t max_frame_size = 1 + sensor_count + 5 + 1 + 4 + 1;

struct GloveFrameReader {
    GloveFrameLayout layout;
    char letter = 'S';
    // The partial frame, and totals.
    std::array<std::uint8_t, max_frame_size> bytes{};
    std::size_t count = 0;
    std::uint64_t frames = 0;
    std::uint64_t lost = 0;  // bytes outside valid frames
};

// Finds frames in the byte stream of a glove, which may lose, insert or change bytes. Accepts bytes in blocks
// of any size and calls `on_frame` for each complete frame. Allocates nothing.
void read_frames(GloveFrameReader& reader, std::span<const std::uint8_t> bytes,
                 FunctionRef<void(const GloveFrame&)> on_frame);

// The reply to a query ('?' and a letter) repeats both and adds the value; the reply to a setting is its
// letter. Each ends with a zero. The reply to an unknown command is "e?", a carriage return, a
// newline and a zero.

struct GloveIdentity {
    std::size_t sensors = 0;  // 18 or 22
    Side side = Side::right;
    bool plugged = true;  // the glove is connected to its interface unit
    std::string version;  // of the firmware; empty for old ones that do not report it
};

struct GloveHandshakeOptions {
    double rate = 80.0;          // requested samples per second
    double quiet_time = 0.06;    // s without a byte until streaming counts as stopped
    double reply_timeout = 0.3;  // s until a reply times out
    int tries = 3;               // attempts per step
    // s until the command to stop is repeated on a line that keeps sending; it is sent at most `tries` times.
    double quiet_timeout = 1.0;
};

// The handshake with a glove: reads its identity and configures the stream.
class GloveHandshake {
  public:
    explicit GloveHandshake(const GloveHandshakeOptions& options = {}) : options_(options) {}

    // `received`: bytes since the last call; `now`: s on a monotonic clock. Returns the bytes to send,
    // possibly none. Call until done() or failed(): when bytes arrive, and at least every 20 ms.
    std::vector<std::uint8_t> update(std::span<const std::uint8_t> received, double now);

    [[nodiscard]] bool done() const { return step_ == HandshakeStep::streaming; }
    [[nodiscard]] const std::optional<Error>& failed() const { return failed_; }
    [[nodiscard]] const GloveIdentity& identity() const { return identity_; }

  private:
    enum class HandshakeStep : std::uint8_t {
        stop_streaming,
        query_sensors,   // number of sensors
        query_samples,   // number of values in a frame
        set_samples,     // to the number of sensors
        query_side,      // right or left hand
        query_plugged,   // whether the glove is connected to its interface unit
        query_version,   // of the firmware
        disable_status,  // leaves the status byte out of the frames
        disable_time,    // leaves the time out of the frames
        set_rate,        // samples per second
        streaming
    };
    using Bytes = std::vector<std::uint8_t>;

    [[nodiscard]] Bytes query_bytes() const;
    bool parse_reply();
    bool store_value(std::uint8_t value);
    Bytes start_step(HandshakeStep step, double now);
    void fail_with(std::string what, std::string expected);

    GloveHandshakeOptions options_;
    GloveIdentity identity_;
    std::optional<Error> failed_;
    Bytes reply_;
    HandshakeStep step_ = HandshakeStep::stop_streaming;
    bool started_ = false;
    double since_ = 0.0, last_byte_ = 0.0;
    int attempts_ = 0;
    std::uint8_t samples_ = 0;  // values in a frame, as the glove reports
};

enum class GloveState : std::uint8_t {
    handshake,  // identifying the glove
    streaming,
    silent,    // streamed before, sends nothing now
    rejected,  // the device on the line is not a supported glove; retried later
};

struct GloveSessionOptions {
    GloveHandshakeOptions handshake;
    double silence = 0.25;  // s without a frame until a new handshake
    double pause = 1.0;     // s until a rejected device is tried again
};

// The whole communication with a glove: handshake, stream, and a new handshake after silence.
class GloveSession {
  public:
    explicit GloveSession(const GloveSessionOptions& options = {});

    // `received`: bytes since the last call; `now`: s. Returns the bytes to send; calls `on_frame` for each
    // frame.
    std::vector<std::uint8_t> update(std::span<const std::uint8_t> received, double now,
                                     FunctionRef<void(const GloveFrame&)> on_frame);

    [[nodiscard]] GloveState state() const { return state_; }
    // From the last successful handshake.
    [[nodiscard]] const GloveIdentity& identity() const { return identity_; }
    [[nodiscard]] const std::string& fault_message() const { return fault_message_; }  // empty: none
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    [[nodiscard]] std::uint64_t lost_bytes() const { return lost_ + reader_.lost; }
    [[nodiscard]] std::uint64_t handshakes() const { return handshakes_; }  // that succeeded

  private:
    std::vector<std::uint8_t> start_handshake(double now, GloveState meanwhile);

    GloveSessionOptions options_;
    GloveState state_ = GloveState::handshake;
    GloveHandshake handshake_;
    GloveFrameReader reader_;
    GloveIdentity identity_;
    std::string fault_message_;
    double since_ = 0.0;
    bool started_ = false;
    std::uint64_t frames_ = 0, lost_ = 0, handshakes_ = 0;
};

}  // namespace bolt::hand
