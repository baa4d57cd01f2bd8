#include "haptics/force/output_stage.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

OutputCommand render(const OutputLimits& limits, OutputStage& stage, const PortInput& input,
                     const Wanted& wanted, double dt) {
    const bool sound = finite(wanted.command.force) && finite(wanted.command.torque) &&
                       std::isfinite(wanted.stored) && std::isfinite(wanted.granted);
    const bool may = watch(limits, stage.watchdog, input, sound, dt) && input.enabled;
    const Motion& motion = stage.watchdog.motion;
    PassivityState& passivity = stage.passivity;
    observe(limits, passivity, motion, 1.0 + input.missed);

    OutputCommand command;
    if (may) {
        const double before = stage.output.strength;
        const double strength = std::min(1.0, before + dt / limits.ramp_up);
        command = control(limits, passivity, motion, wanted, strength, before, dt);
    } else {
        passivity.balance = passivity.stored = passivity.damping = 0.0;
        if (!sound) command = wanted.command;  // the limiter counts it and makes nothing of it
    }
    // A silent device has used up a part of its time already.
    const bool silent = stage.watchdog.fault == Fault::silent;
    const double release = silent ? limits.release - limits.silence - dt : limits.release;
    const OutputCommand sent = limit_output(limits, stage.output, command, may, dt, release);
    note_sent(passivity, sent);
    return sent;
}

}  // namespace bolt::force
