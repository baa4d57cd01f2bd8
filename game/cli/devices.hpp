// What of devices doctor says.
#pragma once

#include <string>

namespace bolt::cli {

// A line: how many of what are plugged in, how many cannot be used.
std::string devices_line();

}  // namespace bolt::cli
