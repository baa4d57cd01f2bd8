// The side of a hand.
#pragma once

#include <cstdint>

namespace bolt {

enum class Side : std::uint8_t { left, right };

}  // namespace bolt
