// Serial ports: opening, reading and writing one, and checks of its adapter and of access to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt {

// A serial port or a pseudo-terminal: 115200 baud, 8N1, raw, no flow control.
class SerialPort {
  public:
    // Fails if there is no such port, access is not permitted, the port is in use, or it is not a serial
    // port.
    static Result<SerialPort> open(const std::filesystem::path& path);

    SerialPort(SerialPort&& other) noexcept;
    SerialPort& operator=(SerialPort&& other) noexcept;
    ~SerialPort();

    // Waits at most `timeout` seconds for bytes; empty on timeout. Error::lost: the port has disappeared.
    Result<std::vector<std::uint8_t>> read(double timeout);
    // Writes all bytes or fails with Error::lost, also after one second without progress.
    Status write(const std::vector<std::uint8_t>& bytes);

  private:
    explicit SerialPort(int file) : file_(file) {}
    int file_ = -1;
};

// Ports of USB adapters, under their persistent names if available, sorted.
std::vector<std::filesystem::path> serial_ports();

// Checks that the port exists and that the user may access it. Does not open it, because some devices reset
// when their port opens; so a port that is in use passes. The error names the group that the user must join.
Status check_port_access(const std::filesystem::path& port);

// Time in ms for which the adapter buffers bytes (FTDI default: 16); nullopt if it has no such timer.
// `devices`: the sysfs folder.
std::optional<int> latency_timer_ms(const std::filesystem::path& port,
                                    const std::filesystem::path& devices = "/sys/bus/usb-serial/devices");

}  // namespace bolt
