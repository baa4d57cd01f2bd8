// What a device can, in words for whoever plugs it in.
#pragma once

#include <string>
#include <vector>

#include "haptics/device/device.hpp"

namespace bolt::device {

// A line each: how it says where the hand is, what it renders, its remarks.
std::vector<std::string> words(const Description& description);

}  // namespace bolt::device
