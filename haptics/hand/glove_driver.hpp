// A serial port, or a pseudo-terminal that stands for one: 115200 baud, 8N1, raw, no flow control.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/result.hpp"
#include "haptics/hand/glove_protocol.hpp"

namespace bolt::hand {

class SerialPort {
  public:
    // Errors say what to do: no such port, not permitted (which group), in use, not a serial port.
    static Result<SerialPort> open(const std::filesystem::path& path);

    SerialPort(SerialPort&& other) noexcept;
    SerialPort& operator=(SerialPort&& other) noexcept;
    ~SerialPort();

    // Waits until something comes, at most `timeout` seconds. Empty: nothing came. An error with `lost`: the
    // port is gone.
    Result<std::vector<std::uint8_t>> read(double timeout);
    // All of it, or an error; waits at most a second.
    Status write(const std::vector<std::uint8_t>& bytes);

  private:
    explicit SerialPort(int file) : file_(file) {}
    int file_ = -1;
};

// Ports that a glove may be on, by their names that stay the same, best first.
std::vector<std::filesystem::path> serial_ports();

// Checks of the serial adapter of a glove: permission and latency.

// Checks that the port can be opened, without opening it, because some devices reset when their port opens.
// The error names the group that the user must join.
Status check_port_access(const std::filesystem::path& port);

// Time in ms for which the adapter buffers bytes (FTDI default: 16); nullopt if it has no such timer.
// `devices`: the sysfs folder.
std::optional<int> latency_timer_ms(const std::filesystem::path& port,
                                    const std::filesystem::path& devices = "/sys/bus/usb-serial/devices");

// A glove on a serial port, read by its own thread. Readers get the latest sample and report without waiting.

struct GloveSample {
    GloveFrame frame;
    std::uint64_t number = 0;  // 0: none yet
    double time = 0.0;         // s on the steady clock, when its last byte was read
};

struct GloveReport {
    bool open = false;  // the port
    GloveState state = GloveState::handshake;
    GloveIdentity identity;
    std::array<char, 200> trouble{};  // zero-terminated text; empty: none
    std::uint64_t frames = 0, lost_bytes = 0, handshakes = 0, openings = 0;
    // s: time of the latest frame on the steady clock, and the longest gap between frames up to now.
    double newest = 0.0, longest_silence = 0.0;
};

class GloveDriver {
  public:
    // Returns immediately. If the port cannot be opened, the thread retries and the report has the reason.
    static GloveDriver start(std::filesystem::path port, const GloveSessionOptions& options = {});

    GloveDriver(GloveDriver&&) noexcept;
    GloveDriver& operator=(GloveDriver&&) noexcept;
    ~GloveDriver();  // stops the thread

    // One calling thread each.
    const GloveSample& sample();
    const GloveReport& report();

  private:
    struct Shared;
    explicit GloveDriver(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::hand
