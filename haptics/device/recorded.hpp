// A device that plays recorded samples at their recorded times. The caller supplies the samples.
#pragma once

#include <cstddef>

#include "haptics/device/device.hpp"
#include "haptics/device/timer.hpp"

namespace bolt::device {

// Returns sample `index`, with increasing times; nullopt after the last.
using Recording = std::function<std::optional<Sample>(std::size_t index)>;

// Restarts at each opening. After the last sample the pose stays and all buttons are released. Rendered force
// has no effect.
DeviceFactory recorded(Description description, Recording recording, Timer timer);

}  // namespace bolt::device
