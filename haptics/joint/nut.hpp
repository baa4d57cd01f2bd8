// The mechanism of a click-type torque wrench (ISO 6789-1: type II, class A), in series between the hand and
// the wrench's spring. Up to its setting it is a rigid piece; there it trips, and the handle swings on
// against less, until it bottoms and is a rigid piece again: who pulls on puts in more. Let go of it swings
// back, and holds up to its setting anew. Only tightening trips it.
//
//   not swung     T ≤ setting
//   swinging on   T = falls_to · setting + c · speed      back   T = rearms_at · setting + c · speed
//   bottomed      T ≥ rearms_at · setting
//
// c = stiffness · settles: held still, the torque falls with that time constant and does not jump. Between
// its two torques a mechanism that has swung stands, so that swinging to and fro takes energy and never gives
// any.
#pragma once

#include <string_view>

#include "haptics/joint/design.hpp"
#include "haptics/joint/mechanistic.hpp"

namespace bolt::joint {

// What it is. The shares and times are ours: the standard is about the setting alone.
struct Click {
    double setting = 0.0;    // N·m at which it trips; 0: it never does
    double swing = 0.0;      // rad that the handle swings before it bottoms; 0: there is no mechanism
    double falls_to = 0.5;   // of the setting, above rearms_at
    double rearms_at = 0.2;  // of the setting, above 0
    double settles = 0.01;   // s

    [[nodiscard]] bool trips() const { return setting > 0.0 && swing > 0.0; }
};

// How it stands after a step.
struct ClickStep {
    double swung = 0.0;    // rad, 0 … swing
    bool clicked = false;  // it tripped in this step
};

// The nut on its thread, driven by a hand through a wrench: it stands until the torque overcomes the
// resistance, then follows, with no chatter at rest and no energy made.
//
// Coulomb friction is set-valued at rest. One implicit step of the velocity (Moreau's time stepping) resolves
// it in closed form: stand, turn on, or turn off, whichever is consistent; there is nothing to iterate and
// nothing to tune.

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

// What the corners of a nut bear before an open jaw slips over them.
//
// A jaw that turns beyond its play bears on a strip of each flat, from the corner inward, at opposite
// corners. Limit analysis: the strips flow at one pressure p; strips of width b at x1 and x2 from the axis
// and of height e carry T = p e b (x1 + x2 - b), most where b = (x1 + x2)/2:
//
//   T = p e ((x1 + x2)/2)²
//
// p is that of a flat die on one flank of a wedge up to its edge, p = 2k (1 + ψ - π/2) for an obtuse angle ψ
// (R. Hill, The Mathematical Theory of Plasticity, 1950; at ψ = π it is Prandtl's punch), ψ = 120° here and
// 2k = 2/√3 of the flow stress, which is a third of the hardness (D. Tabor, The Hardness of Metals, 1951).
// The hardness is the least that ISO 898-2 asks of a nut's class.
//
// Modelling assumptions: rigid and ideally plastic, the jaw harder than the nut, no friction; a face that is
// tilted bears as far as it stands off by less than the clearance to one side.

// Pa, least Vickers hardness of the nut that belongs to a bolt of this class (ISO 898-2, table of classes 5
// to 12: a nut's class is the first number of the bolt's). Stainless nuts have no such table: three times the
// tensile strength of their grade.
double nut_hardness(const PropertyClass& bolt_class, double d);

// p, Pa.
double corner_pressure(double hardness);

struct CornerGrip {
    double height = 0.0;                             // e, m, in which flat is on flat
    double toward_throat = 0.0, toward_mouth = 0.0;  // x1, x2: m from the axis to the ends of the strips
    double tilt = 0.0;                               // rad, about the flats' length
    double clearance = 0.0;                          // m, half of opening less across flats
    double lost = 0.0;                               // m of the flats that is rounded off at each corner
};

// N·m at which it slips.
double corner_torque(double pressure, const CornerGrip& grip);

// Free turn to either side, rad, of a jaw on a nut of which `lost` m of each flat's ends are gone; 30° where
// it turns round and round.
double rounded_half_play(double opening, double across_flats, double lost);

}  // namespace bolt::joint
