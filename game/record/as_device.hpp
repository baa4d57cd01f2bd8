// A session's hand as a device that moves the tool again as it was moved (haptics/device/recorded.hpp), in
// the assembly's frame: for a station whose workspace maps nothing and whose tool begins at `first`.
#pragma once

#include "game/record/session.hpp"
#include "haptics/device/recorded.hpp"

namespace bolt::record {

struct RecordedHand {
    device::Description description;  // renders what the device of then did
    device::Recording recording;      // silent ticks are gaps
    Pose first;
};

// Bits of its buttons.
inline constexpr std::uint32_t button_held = 1, button_stop = 2, button_reset = 4;

// Reads the whole session: 40 bytes a tick. An error: it is damaged, or has no tick.
Result<RecordedHand> as_device(const Reader& session);

}  // namespace bolt::record
