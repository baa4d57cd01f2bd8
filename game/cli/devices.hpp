// The summary of the connected devices for boltwright doctor.
#pragma once

#include <string>

namespace bolt::cli {

// One line: the number of USB devices, of those that cannot be used, and of serial ports.
std::string devices_line();

}  // namespace bolt::cli
