#include "haptics/station/layout.hpp"

#include <algorithm>

namespace bolt::station {

using device::Description;
using device::Sensing;

bool renders_force(const Description& d) {
    return d.limits.force > 0.0 && (d.renders[0] || d.renders[1] || d.renders[2]);
}

bool renders_torque(const Description& d) {
    return d.limits.torque > 0.0 && (d.renders[3] || d.renders[4] || d.renders[5]);
}

Status check(const Layout& layout) {
    if (!layout.mover && !layout.wheel)
        return fail(ErrorCode::no_device, "station: no device is selected", "a device that moves the tool");
    if (layout.mover && layout.mover->sensing == Sensing::turn)
        return fail(ErrorCode::no_device,
                    "station: " + layout.mover->name + " turns about one axis and cannot move the tool",
                    "that device as the wheel, and another device or the mouse as the mover");
    if (layout.wheel && layout.wheel->sensing != Sensing::turn)
        return fail(ErrorCode::no_device, "station: " + layout.wheel->name + " is not a wheel",
                    "a device that turns about one axis; this one can be the mover");
    return {};
}

force::OutputLimits limits_of(const Layout& layout) {
    force::OutputLimits limits;
    limits.force = limits.torque = 0.0;
    if (layout.mover) {
        force::OutputLimits mover = layout.mover->limits;
        if (!renders_force(*layout.mover)) mover.force = 0.0;
        if (!renders_torque(*layout.mover)) mover.torque = 0.0;
        limits = force::in_assembly(layout.workspace, mover);
    }
    limits.release -= transport_delay;
    if (!layout.wheel) return limits;
    const force::OutputLimits& wheel = layout.wheel->limits;
    limits.torque = renders_torque(*layout.wheel) ? wheel.torque : 0.0;
    limits.torque_rate = wheel.torque_rate;
    limits.torsion = wheel.torsion;
    limits.angular_damping = wheel.angular_damping;
    limits.angular_speed = wheel.angular_speed;
    limits.angular_jump = wheel.angular_jump;
    limits.delay = std::max(limits.delay, wheel.delay);
    limits.ramp_up = std::max(limits.ramp_up, wheel.ramp_up);
    return limits;
}

}  // namespace bolt::station
