// Time-domain passivity: observes the energy at the device's port and removes energy that the rendering
// generates. A sampled, delayed and slew-limited spring returns more energy than was put in, which a hand
// feels as vibration.
//
// Hannaford, Ryu: Time-domain passivity control of haptic interfaces. IEEE Trans. Robotics and Automation
// 18(1), 2002. The stored energy is the reference, as in Ryu, Preusche, Hannaford, Hirzinger: Time domain
// passivity control with reference energy following. IEEE Trans. Control Systems Technology 13(5), 2005.
#pragma once

#include <array>

#include "haptics/force/output_limits.hpp"
#include "haptics/force/watchdog.hpp"

namespace bolt::force {

// A requested command with its energy. Both energies may be 0; then the controller permits only energy that
// the hand put in shortly before.
struct ForceRequest {
    OutputCommand command;
    double stored_energy =
        0.0;  // J that the springs behind it hold and may give back; never more than they do
    double injected_energy =
        0.0;  // J that they gained in this tick by no work of the hand: help that is meant to be
};

struct PassivityState {
    // J that the hand put in and did not get back, less the stored energy. Negative: energy was generated.
    double balance = 0.0;
    double stored_energy = 0.0;  // J, of the last request
    double removed = 0.0;        // J removed by the controller since the start
    double damping = 0.0;        // 0 … 1, active share of the permitted damping

    std::array<OutputCommand, 4> sent{};  // commands sent, newest first
    OutputCommand applied;                // sum of the commands since the last sample, over `ticks`
    double ticks = 0.0;
};

// Share of OutputLimits::damping that is used: damping is sampled and delayed as well (Colgate, Schenkel
// 1997).
inline constexpr double damping_share = 0.9;

// Largest credit, J, and time constant of its decay, s: energy dissipated long ago must not pay for vibration
// now. With 0.5 mJ of credit a tool rocking on a ball vibrated for one second. A spring of 1 N/mm pressed at
// 0.3 m/s at 1 kHz generates 45 µJ per tick, so 0.2 mJ prevents a reaction to single ticks.
inline constexpr double saved_at_most = 0.2e-3;
inline constexpr double saved_for = 0.03;

// 1/s, rates at which damping sets in and ends. A step of damping would itself be a jolt of up to 2 N at 0.1
// m/s; energy that is not removed at once is removed a few milliseconds later.
inline constexpr double damping_comes = 60.0, damping_goes = 40.0;

// The observer: adds the work of the applied commands along the motion since the last sample. `ticks`:
// periods that passed, missed deadlines included.
void observe(const OutputLimits& limits, PassivityState& state, const Motion& motion, double ticks);

// The controller: returns the command, clamped and with as much damping as the deficit needs and the device
// permits. `strength` is the ramp's share now, `before` that of the last tick.
OutputCommand control(const OutputLimits& limits, PassivityState& state, const Motion& motion,
                      const ForceRequest& request, double strength, double before, double dt);

// Call after each tick with the command that was sent.
void note_sent(PassivityState& state, const OutputCommand& sent);

}  // namespace bolt::force
