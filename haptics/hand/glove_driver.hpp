// The driver of a glove on a serial port: the port, checks of its adapter, and the thread that reads it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/hand/glove_protocol.hpp"

namespace bolt::hand {

// A serial port or a pseudo-terminal: 115200 baud, 8N1, raw, no flow control.
class SerialPort {
  public:
    // Fails if there is no such port, access is not permitted (the error names the group), the port is in
    // use, or it is not a serial port.
    static Result<SerialPort> open(const std::filesystem::path& path);

    SerialPort(SerialPort&& other) noexcept;
    SerialPort& operator=(SerialPort&& other) noexcept;
    ~SerialPort();

    // Waits at most `timeout` seconds for bytes; empty on timeout. Error::lost: the port has disappeared.
    Result<std::vector<std::uint8_t>> read(double timeout);
    // Writes all bytes or fails. Times out after one second without progress.
    Status write(const std::vector<std::uint8_t>& bytes);

  private:
    explicit SerialPort(int file) : file_(file) {}
    int file_ = -1;
};

// Ports that a glove may be connected to, under their persistent names if available, sorted.
std::vector<std::filesystem::path> serial_ports();

// Checks that the port can be opened, without opening it, because some devices reset when their port opens.
// The error names the group that the user must join.
Status check_port_access(const std::filesystem::path& port);

// Time in ms for which the adapter buffers bytes (FTDI default: 16); nullopt if it has no such timer.
// `devices`: the sysfs folder.
std::optional<int> latency_timer_ms(const std::filesystem::path& port,
                                    const std::filesystem::path& devices = "/sys/bus/usb-serial/devices");

struct GloveSample {
    GloveFrame frame;
    std::uint64_t number = 0;  // 0: none yet
    double time = 0.0;         // s on the steady clock, when its last byte was read
};

struct GloveReport {
    bool open = false;  // the port
    GloveState state = GloveState::handshake;
    GloveIdentity identity;
    std::array<char, 200> fault_message{};  // zero-terminated text; empty: none
    std::uint64_t frames = 0, lost_bytes = 0, handshakes = 0, openings = 0;
    // s: time of the latest frame on the steady clock, and the longest gap between frames up to now.
    double newest = 0.0, longest_silence = 0.0;
};

// Reads a glove on its own thread. Readers get the latest sample and report without waiting.
class GloveDriver {
  public:
    // Returns immediately. If the port cannot be opened, the thread retries and the report has the reason.
    static GloveDriver start(std::filesystem::path port, const GloveSessionOptions& options = {});

    GloveDriver(GloveDriver&&) noexcept;
    GloveDriver& operator=(GloveDriver&&) noexcept;
    ~GloveDriver();  // stops the thread

    // Call each of these from one thread only.
    const GloveSample& sample();
    const GloveReport& report();

  private:
    struct Shared;
    explicit GloveDriver(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::hand
