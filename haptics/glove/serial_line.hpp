// A serial port, or a pseudo-terminal that stands for one: 115200 baud, 8N1, raw, no flow control.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::glove {

class SerialLine {
  public:
    // Errors say what to do: no such port, not permitted (which group), in use, not a serial port.
    static Result<SerialLine> open(const std::filesystem::path& path);

    SerialLine(SerialLine&& other) noexcept;
    SerialLine& operator=(SerialLine&& other) noexcept;
    ~SerialLine();

    // Waits until something comes, at most `patience` seconds. Empty: nothing came. An error with `lost`: the
    // port is gone.
    Result<std::vector<std::uint8_t>> read(double patience);
    // All of it, or an error; waits at most a second.
    Status write(const std::vector<std::uint8_t>& bytes);

  private:
    explicit SerialLine(int file) : file_(file) {}
    int file_ = -1;
};

// Ports that a glove may be on, by their names that stay the same, best first.
std::vector<std::filesystem::path> serial_ports();

}  // namespace bolt::glove
