// How the emulated wheels describe their reports.
#pragma once

#include "tools/emulate/hid.hpp"

namespace bolt::emulate {

// As OpenFFBoard's firmware numbers them; of its effects only constant force.
Bytes board_descriptor();

// Another wheel's: other numbers, an axis without a sign, controls as a list, one effect in a fixed place,
// no start delay.
Bytes other_wheel_descriptor();

}  // namespace bolt::emulate
