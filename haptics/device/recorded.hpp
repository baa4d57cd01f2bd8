// A device that plays what was recorded of one, at the pace it had. Where the samples lie is their owner's
// business.
#pragma once

#include <cstddef>

#include "haptics/device/device.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::device {

// The samples one after the other, times rising; none: there are no more.
using Recording = std::function<std::optional<Sample>(std::size_t index)>;

// Begins anew whenever it is opened. At its end the hand stays where it is and lets all buttons go. What is
// rendered moves nobody.
Open recorded(Description description, Recording recording, Timer timer);

}  // namespace bolt::device
