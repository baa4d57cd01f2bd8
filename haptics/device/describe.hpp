// Describes a device in plain text for `boltwright devices`.
#pragma once

#include <string>
#include <vector>

#include "haptics/device/device.hpp"

namespace bolt::device {

// One line each for what it senses, what it renders, and its remarks.
std::vector<std::string> summary_lines(const Description& description);

}  // namespace bolt::device
