// The nut on its thread: its motion under the torque of a hand or wrench, the mechanism of a click-type
// torque wrench, and the torque that a nut's corners bear.
#pragma once

#include <limits>
#include <string_view>

#include "haptics/joint/design.hpp"
#include "haptics/joint/mechanistic.hpp"

namespace bolt::joint {

// The mechanism of a click-type torque wrench (ISO 6789-1: type II, class A), in series between the hand and
// the wrench's spring. It is rigid up to its set torque. There it trips, and the handle swings on at a lower
// torque until it bottoms and is rigid again, so a further pull applies more torque. When released it swings
// back and rearms. Only tightening trips it.
//
//   not swung      T ≤ set torque
//   swinging on    T = swing_torque_share · set torque + c · speed
//   swinging back  T = rearm_torque_share · set torque + c · speed
//   bottomed       T ≥ rearm_torque_share · set torque
//
// c = stiffness · settling_time: with hand and nut at rest the torque falls with that time constant instead
// of jumping. At torques between those of swinging on and swinging back the mechanism does not move, so
// swinging back and forth dissipates energy and never generates any. The shares and times are ours, because
// the standard specifies the set torque only.
struct Click {
    double set_torque = 0.0;          // N·m at which it trips; 0: never
    double swing = 0.0;               // rad that the handle swings before it bottoms; 0: no mechanism
    double swing_torque_share = 0.5;  // fraction of the set torque; greater than rearm_torque_share
    double rearm_torque_share = 0.2;  // fraction of the set torque; positive
    double settling_time = 0.01;      // s

    [[nodiscard]] bool trips() const { return set_torque > 0.0 && swing > 0.0; }
};

// Torque at the nut, divided by that on the scale of a torque wrench: (L + e cos φ) / L for an adaptor of the
// length e (m) on a wrench with the lever L (m, from the drive to the mark on the grip), at the angle φ (rad)
// to the handle. In line, the adaptor lengthens the lever; at a right angle it changes nothing.
double adaptor_ratio(double lever, double adaptor, double angle = 0.0);

// State of the mechanism after a step.
struct ClickStep {
    double swung = 0.0;    // rad, 0 … swing
    bool clicked = false;  // it tripped in this step
};

struct NutMotion {
    double angle = 0.0;  // rad
    double speed = 0.0;  // rad/s
};

// The drive of the nut: a spring with play between the angles of hand and nut.
struct NutDrive {
    bool engaged = false;  // false: no drive
    // rad, the angle of the nut when it was gripped, plus the hand's rotation since then. step_nut() measures
    // these angles relative to the bolt; step_group(), where the bolt may turn too, in the assembly's frame.
    double angle = 0.0;
    double half_play = 0.0;  // rad, backlash to either side
    double stiffness = 0.0;  // N·m/rad
    // N·m at which the drive slips: fingertips, the corners of a nut, the pawl of a ratchet; 0: never.
    double torque_limit = 0.0;
    // N·m, torque with which a second wrench or fingers hold the held part, besides the friction under it
    // (CounterHold::second_wrench); infinite: it cannot turn. Only step_group() uses it.
    double held_part_torque = std::numeric_limits<double>::infinity();
    Click click;         // between hand and spring
    double swung = 0.0;  // rad that the click mechanism has swung, 0 … click.swing
};

struct NutStep {
    NutMotion nut;
    double torque = 0.0;          // N·m on the nut, tightening positive
    double friction_share = 0.0;  // −1…1, friction torque ÷ its maximum after the step; +1: slides tightening
    bool slipped = false;         // the drive's torque limit was reached
    ClickStep click;
};

// One step of a nut on its thread: the nut stands until the torque overcomes the resistance, then follows the
// drive, without chatter at rest and without generating energy. Coulomb friction is set-valued at rest; one
// implicit velocity step (Moreau's time stepping) resolves it in closed form. The nut rests, tightens or
// loosens, whichever is consistent.
//
// `inertia` (kg·m² about the bolt) acts while the spring of the drive is wound; see drive_inertia().
// Inside the play the nut's own inertia acts, which is much smaller.
//
// The step is stable if the slope of the resistance is at least −(0.9 inertia/dt² + stiffness), N·m/rad. The
// resistance of a joint that is loosened may fall more steeply. The step then computes with this bound as the
// slope, so the nut turns less than it should.
NutStep step_nut(const Resistance& resistance, double inertia, NutMotion nut, const NutDrive& drive,
                 double dt);

// N·m that the drive applies to a nut at rest at this angle.
double wound_torque(const NutDrive& drive, double nut_angle);

// The smallest inertia, kg·m², for which a step of `dt` (s) resolves the spring of the drive: K dt².
inline double drive_inertia(double stiffness, double dt) { return stiffness * dt * dt; }

// The torque that the corners of a nut bear before an open jaw slips over them.
//
// A jaw that turns beyond its play bears on a strip of each flat, from the corner inward, at opposite
// corners. Limit analysis: the strips flow at one pressure p. Strips of width b and height e, whose outer
// ends (at the corners) are x1 and x2 from the axis, carry T = p e b (x1 + x2 - b), which is greatest at b =
// (x1 + x2)/2:
//
//   T = p e ((x1 + x2)/2)²
//
// The jaw is a flat die on one flank of a wedge with the angle ψ, which reaches to the edge of the wedge:
//
//   p = 2k (1 + ψ - π/2)   for an obtuse ψ (R. Hill, The Mathematical Theory of Plasticity, 1950)
//   ψ = 120°               of a hexagon
//   2k = 2/√3 σ            σ: flow stress
//   σ = H / 3              H: hardness (D. Tabor, The Hardness of Metals, 1951), the minimum that ISO 898-2
//                          requires for the nut's class
//
// Modelling assumptions: rigid and ideally plastic, the jaw harder than the nut, no friction; a jaw
// that is tilted by θ bears only over the height clearance / tan θ.

// Pa, minimum Vickers hardness of the nut that matches a bolt of this class and of the nominal diameter `d`
// (m). ISO 898-2, table of classes 5 to 12: a nut's class is the first number of the bolt's, and 5 for bolts
// of 4.6 and 4.8. For stainless nuts, which have no such table, three times the tensile strength of their
// grade.
double nut_hardness(const PropertyClass& bolt_class, double d);

// Pa, minimum Vickers hardness of a bolt of the nominal diameter `d` (m; ISO 898-1 table 3). For stainless
// bolts three times the tensile strength of their grade.
double bolt_hardness(const PropertyClass& bolt_class, double d);

// Pa, of the part whose corners the tool grips.
double turned_part_hardness(const JointDesign& design);

// Pa, the pressure p above. `hardness` in Pa.
double corner_pressure(double hardness);

// Pa, the pressure at which the walls of a head's hexagonal socket yield under the corners of a harder key:
// Prandtl's punch, 2k (1 + π/2), because a wall reaches beyond the strip on both sides. `hardness` in Pa.
double socket_pressure(double hardness);

struct CornerGrip {
    double height = 0.0;                             // e, m, height of the contact between flats
    double toward_throat = 0.0, toward_mouth = 0.0;  // x1, x2: m from the axis to the ends of the strips
    double tilt = 0.0;                               // rad, about the flats' length
    double clearance = 0.0;                          // m, half of (opening − across flats)
    double rounded = 0.0;                            // m that the corner has lost along each of its two flats
};

// N·m at which the jaw slips. `pressure`: corner_pressure().
double corner_torque(double pressure, const CornerGrip& grip);

// A ring, a socket or a key bears at all six corners. On each flat it bears on the strip from the corner, at
// x from the middle of the flat, inward to x0, with the lever (x + x0)/2:
//
//   T = 6 p e (x − x0) (x + x0)/2 = 3 p e (x² − x0²)
//
// x0 = 0 for one hexagon, which reaches to the middle of the flat. The teeth of a hole with 12 points end at
// x0 = s/2 tan 15°.
struct RingGrip {
    double height = 0.0;        // e, m
    double across_flats = 0.0;  // s, m
    int points = 6;             // 6 or 12
    double tilt = 0.0;          // rad, between the axes of tool and nut
    double clearance = 0.0;     // m, half of the difference of the widths across flats
    double rounded = 0.0;       // m that each corner has lost along each flat
};

// N·m at which the ring, socket or key slips. `pressure`: corner_pressure(), for a key socket_pressure().
double ring_torque(double pressure, const RingGrip& grip);

// Play to either side, rad, of a jaw on a nut whose corners are rounded (CornerGrip::rounded); 30° if the jaw
// turns freely.
double rounded_half_play(double opening, double across_flats, double rounded);

}  // namespace bolt::joint
