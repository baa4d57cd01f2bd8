// What a station is made of: which device moves the tool, which one turns the wrench on its bolt, and how
// their frames lie to the assembly's.
#pragma once

#include <optional>

#include "haptics/device/device.hpp"
#include "haptics/force/workspace.hpp"

namespace bolt::station {

// Bits of a device's buttons; 0: none does that.
struct Buttons {
    std::uint32_t held = 1;  // the dead-man
    std::uint32_t clutch = 2;
    std::uint32_t stop = 0, reset = 0;
};

struct Layout {
    std::optional<device::Description> mover;  // moves the tool: Sensing::pose or rate
    Buttons mover_buttons;
    // Turns the wrench on its bolt, and feels it: Sensing::turn. With one the mover renders forces only.
    std::optional<device::Description> wheel;
    Buttons wheel_buttons;
    force::Workspace workspace;  // of the mover; of one that gives rates only the turn counts
    Pose home;                   // of the tool in the assembly's frame, when it begins
    std::optional<Pose> wrist;   // of a gloved hand that holds the tool, in its frame
};

// An error: no device at all, or one that cannot do what it is meant for.
Status check(const Layout& layout);

// s that a sample on its way to the servo and an order on its way back wait for a turn each: taken off the
// time in which forces have to be gone.
inline constexpr double way = 2e-3;

// What both render together, as the assembly sees it: for servo::Description::limits.
force::OutputLimits limits_of(const Layout& layout);

// Whether any force, any torque is rendered.
bool renders_force(const device::Description& description);
bool renders_torque(const device::Description& description);

}  // namespace bolt::station
