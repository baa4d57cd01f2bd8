#include "haptics/force/output_stage.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::force {

namespace {

bool finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

OutputCommand render(const OutputLimits& limits, OutputStage& stage, const PortInput& input,
                     const ForceRequest& request, double dt) {
    const bool sound = finite(request.command.force) && finite(request.command.torque) &&
                       std::isfinite(request.stored_energy) && std::isfinite(request.injected_energy);
    const bool permitted = watch(limits, stage.watchdog, input, sound, dt) && input.enabled;
    const Motion& motion = stage.watchdog.motion;
    PassivityState& passivity = stage.passivity;
    observe(limits, passivity, motion, 1.0 + input.missed);

    OutputCommand command;
    if (permitted) {
        const double before = stage.output.strength;
        const double strength = std::min(1.0, before + dt / limits.ramp_up);
        command = control(limits, passivity, motion, request, strength, before, dt);
    } else {
        passivity.balance = passivity.stored_energy = passivity.damping = 0.0;
        if (!sound) command = request.command;  // the limiter counts it as a fault and outputs none of it
    }
    // The release time counts from the last sample, and part of it has already passed.
    const bool silent = stage.watchdog.fault == Fault::silent;
    const double release = silent ? limits.release - limits.silence - dt : limits.release;
    const OutputCommand sent = limit_output(limits, stage.output, command, permitted, dt, release);
    note_sent(passivity, sent);
    return sent;
}

}  // namespace bolt::force
