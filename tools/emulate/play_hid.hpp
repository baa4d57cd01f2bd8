// Emulated HID devices in the kernel, with a hand at them that does the same over and over, for those who
// have none. They end when `ended` says so.
#pragma once

#include <functional>

#include "engine/base/result.hpp"

namespace bolt::emulate {

// Pushed in circles.
Status play_puck(const std::function<bool()>& ended);

// Rocked to and fro; tells the torque of its motor whenever there is another one.
Status play_wheel(bool board, const std::function<bool()>& ended);

}  // namespace bolt::emulate
