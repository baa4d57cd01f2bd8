// The devices of a station: which one moves the tool, which one turns the wrench on its bolt, and the
// transforms between their frames and the assembly's.
#pragma once

#include <optional>

#include "haptics/device/device.hpp"
#include "haptics/force/workspace.hpp"

namespace bolt::station {

// Bit masks of a device's buttons; 0: no button has that function.
struct Buttons {
    std::uint32_t held = 1;  // dead-man switch
    std::uint32_t clutch = 2;
    std::uint32_t stop = 0, reset = 0;
};

struct Layout {
    std::optional<device::Description> mover;  // moves the tool: Sensing::pose or rate
    Buttons mover_buttons;
    // Turns the wrench on its bolt and renders the torque: Sensing::turn. With a wheel the mover renders
    // forces only.
    std::optional<device::Description> wheel;
    Buttons wheel_buttons;
    force::Workspace workspace;  // of the mover; for a device that gives rates only `turn` applies
    Pose home;                   // initial pose of the tool in the assembly's frame
    std::optional<Pose> wrist;   // of a gloved hand that holds the tool, in the tool's frame
};

// Fails with ErrorCode::no_device if there is no device or a device cannot take its role.
Status check(const Layout& layout);

// s that a sample waits for the servo and a command for the device thread, together; subtracted from the time
// in which forces must be released.
inline constexpr double transport_delay = 2e-3;

// The combined limits of the devices in the assembly's units, for servo::SetupDescription::limits.
force::OutputLimits limits_of(const Layout& layout);

// Return true if the device renders any force or any torque.
bool renders_force(const device::Description& description);
bool renders_torque(const device::Description& description);

}  // namespace bolt::station
