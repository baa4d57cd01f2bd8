// Checks of the serial adapter of a glove: permission and latency.
#pragma once

#include <filesystem>
#include <optional>

#include "engine/base/result.hpp"

namespace bolt::hand {

// Checks that the port can be opened, without opening it, because some devices reset when their port opens.
// The error names the group that the user must join.
Status check_port_access(const std::filesystem::path& port);

// Time in ms for which the adapter buffers bytes (FTDI default: 16); nullopt if it has no such timer.
// `devices`: the sysfs folder.
std::optional<int> latency_timer_ms(const std::filesystem::path& port,
                                    const std::filesystem::path& devices = "/sys/bus/usb-serial/devices");

}  // namespace bolt::hand
