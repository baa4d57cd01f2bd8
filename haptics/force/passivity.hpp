// The energy that goes through the device's port, watched and kept from being made out of nothing: a sampled,
// late and slew-limited spring gives back more than was put in, and that is what a hand feels as trembling.
//
// Hannaford, Ryu: Time-domain passivity control of haptic interfaces. IEEE Trans. Robotics and Automation
// 18(1), 2002. Against what is stored as a reference, as in Ryu, Preusche, Hannaford, Hirzinger: Time domain
// passivity control with reference energy following. IEEE Trans. Control Systems Technology 13(5), 2005.
#pragma once

#include <array>

#include "haptics/force/output_limits.hpp"
#include "haptics/force/watchdog.hpp"

namespace bolt::force {

// What is to be rendered, and what its maker knows of its energy. Both may be left at 0: then everything that
// is given back must have been put in before, and not long before.
struct Wanted {
    OutputCommand command;
    double stored = 0.0;   // J that the springs behind it hold and may give back; never more than they do
    double granted = 0.0;  // J that they gained in this tick by no work of the hand: help that is meant to be
};

struct PassivityState {
    // J: what the hand put in and did not get back, beyond what is stored. Below 0 energy was made.
    double balance = 0.0;
    double stored = 0.0;   // J, as told last
    double removed = 0.0;  // J, by the controller, ever
    double damping = 0.0;  // 0 … 1: share of the damping allowed that works now

    std::array<OutputCommand, 4> sent{};  // the last first
    OutputCommand applied;                // sum since the last sample, over `ticks`
    double ticks = 0.0;
};

// Of what the device takes (Colgate, Schenkel 1997 give the reason: damping is sampled and late as well).
inline constexpr double damping_share = 0.9;

// J that may be saved up, and s in which what is saved is forgotten: what was dissipated a while ago does not
// pay for trembling now. Rocking on a ball lived for a second on half a millijoule. A spring of 1 N/mm that
// is pressed at 0.3 m/s by a 1 kHz loop makes 45 µJ a tick; this is enough not to act on single ticks.
inline constexpr double saved_at_most = 0.2e-3;
inline constexpr double saved_for = 0.03;

// 1/s: damping that comes or goes at once is itself a jolt, of as much as 2 N at 0.1 m/s. What is not taken
// out now is taken out a few milliseconds later.
inline constexpr double damping_comes = 60.0, damping_goes = 40.0;

// The observer: what the motion since the last sample cost with the forces that were out then.
void observe(const OutputLimits& limits, PassivityState& state, const Motion& motion, double ticks);

// The controller: damps as much as is needed and allowed. `strength` is the share of the wanted force that
// the limiter lets through now, `before` the share in the tick before.
OutputCommand control(const OutputLimits& limits, PassivityState& state, const Motion& motion,
                      const Wanted& wanted, double strength, double before, double dt);

// After each tick, what went out.
void note_sent(PassivityState& state, const OutputCommand& sent);

}  // namespace bolt::force
