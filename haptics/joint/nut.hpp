// The nut on its thread, driven by a hand through a wrench: it stands until the torque overcomes the
// resistance, then follows, with no chatter at rest and no energy made.
//
// Coulomb friction is set-valued at rest. One implicit step of the velocity (Moreau's time stepping) resolves
// it in closed form: stand, turn on, or turn off, whichever is consistent; there is nothing to iterate and
// nothing to tune.
#pragma once

#include "haptics/joint/click.hpp"
#include "haptics/joint/mechanistic.hpp"

namespace bolt::joint {

struct NutMotion {
    double angle = 0.0;  // rad
    double speed = 0.0;  // rad/s
};

// What holds the nut: a spring with play between the hand's angle and the nut's, or nothing.
struct Handle {
    bool engaged = false;
    double angle = 0.0;         // rad, the hand's angle in the nut's count (re-grips taken off)
    double half_play = 0.0;     // rad, backlash to either side
    double stiffness = 0.0;     // N·m/rad
    double torque_limit = 0.0;  // N·m, at which the grip slips (fingers); 0: never
    Click click;                // between hand and spring
    double swung = 0.0;         // rad, how far it has swung: 0 … click.swing
};

struct NutStep {
    NutMotion nut;
    double torque = 0.0;   // N·m on the nut, tightening positive
    double share = 0.0;    // friction share after the step, −1…1
    bool slipped = false;  // the grip's torque limit was reached
    ClickStep click;
};

// `inertia` (kg·m²) of nut and wrench about the bolt while the jaw pushes; inside its play the nut is alone
// and carries next to none. A loosening torque that falls faster than inertia/dt² + stiffness is caught, not
// followed.
NutStep step_nut(const Resistance& given, double inertia, NutMotion nut, const Handle& handle, double dt);

// N·m that the handle gives a nut that stands at this angle.
double wound_torque(const Handle& handle, double nut_angle);

// The inertia that makes the coupling spring resolve within a step.
inline double coupling_inertia(double stiffness, double dt) { return stiffness * dt * dt; }

}  // namespace bolt::joint
