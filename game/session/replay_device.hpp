// The recorded hand of a session as a device that repeats its motion (haptics/device/virtual_devices.hpp), in the
// assembly's frame. For a station with an identity workspace mapping whose tool starts at `first`.
#pragma once

#include "game/session/session_file.hpp"
#include "haptics/device/virtual_devices.hpp"

namespace bolt::session {

struct RecordedHand {
    device::Description description;  // with the limits of the recorded device
    device::Recording recording;      // ticks without a fresh sample are gaps
    Pose first;
};

// Bits of its buttons.
inline constexpr std::uint32_t button_held = 1, button_stop = 2, button_reset = 4;

// Reads the whole session into memory, 40 bytes for each tick. Fails if it is damaged or has no tick.
Result<RecordedHand> replay_device(const Reader& session);

}  // namespace bolt::session
