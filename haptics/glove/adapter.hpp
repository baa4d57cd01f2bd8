// What the system knows of the adapter that a serial port is: whether we may use it, and whether it is quick.
#pragma once

#include <filesystem>
#include <optional>

#include "engine/base/result.hpp"

namespace bolt::glove {

// Whether the port could be opened, without opening it: some things start anew when their port is. The error
// says what to do, with the group's name.
Status may_use(const std::filesystem::path& port);

// ms for which the adapter gathers bytes before it passes them on; none: it is none that does (FTDI's are 16
// unless told otherwise). `devices`: the folder in which the system tells.
std::optional<int> gathers_ms(const std::filesystem::path& port,
                              const std::filesystem::path& devices = "/sys/bus/usb-serial/devices");

}  // namespace bolt::glove
