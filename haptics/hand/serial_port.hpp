// A serial port, or a pseudo-terminal that stands for one: 115200 baud, 8N1, raw, no flow control.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/base/result.hpp"

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

}  // namespace bolt::hand
