// How the threaded part of a bolt yields: load capacity over plastic elongation, from the elastic limit over
// R_p0.2 to R_m at uniform elongation, then necking, then nothing.
//
//   Y(u) = L_e + (L_m − L_e) (1 − e^{−(u/u_c)^¾}) / (1 − e^{−(u_u/u_c)^¾})    up to u_u
//
// Voce hardening with a power below one, so that the slope is infinite at u = 0: the torque curve bends into
// yield without a kink. The shape u_c is set so that the load at 0.2 % plastic strain is R_p0.2 A_s. The form
// is ours; it is pinned to the three strengths that ISO 898-1 gives and to half the elongation after fracture
// as uniform elongation.
#pragma once

#include <cstdint>

#include "engine/base/random.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/fastener.hpp"
#include "haptics/joint/seat_spring.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::joint {

struct PlasticCurve {
    double elastic_load = 0.0;   // L_e, N of equivalent stress × A_s
    double ultimate_load = 0.0;  // L_m
    double scale = 0.0;          // u_c, m
    double uniform = 0.0;        // u_u, m
    double spread = 0.0;         // 1 / (1 − e^{−(u_u/u_c)^¾})
    double fracture = 0.0;       // u_f > u_u, m
    double neck_load = 0.0;      // at u_f, just before it breaks

    // `length`: plastic length (free thread and half the engaged thread), m. `compliance` of the joint bounds
    // the slope of necking so that a turned nut never lets the load snap through (the joint stays a function
    // of angle).
    static PlasticCurve make(const Thread& thread, const PropertyClass& bolt, double length,
                             double compliance);

    struct Point {
        double load = 0.0;   // Y(u), N
        double slope = 0.0;  // dY/du, N/m; +∞ at u = 0
    };
    [[nodiscard]] Point at(double elongation) const;
    [[nodiscard]] double load(double elongation) const { return at(elongation).load; }
    [[nodiscard]] double slope(double elongation) const { return at(elongation).slope; }
};

// The mechanistic law: one continuous state per joint for tightening and loosening, re-use, yield, stripping
// and breaking. Sources beside each part; what is ours says so. All SI.
//
//   closure     x = P θ/2π − gap − plastic − stripped − embedding − what the neighbours press together
//   clamp force F from x: seat_spring.hpp, δ from VDI 2230 (compliance.hpp)
//   torque      T = F P/2π ± r F (μ_G r_t/cos β + μ_K r_b) ± thread drag: torque.hpp (Motosh)
//   yield       F q ≤ Y(plastic), q von Mises of tension and thread torque: torque.hpp, plastic_curve.hpp
//   r           breakaway: 1 + (static ratio − 1) dwell; dwell heals at rest and wears off with sliding

struct MechanisticParameters {
    Thread thread;
    TorqueLevers levers;     // of this bolt: scatter included, wear not
    double mu_thread = 0.0;  // of this bolt
    double kappa = 1.5;
    double gap = 0.0;  // m, nut face to seat at angle 0
    SeatSpring seat;
    PlasticCurve bolt;
    double strip_load = 0.0;      // N, axial load at which the nut's threads shear
    double strip_length = 0.0;    // m of travel until they are gone
    double flow_time = 0.0;       // s, see flow() in mechanistic.cpp
    double embedding = 0.0;       // m, f_Z at the reference load and above
    double embedding_time = 0.0;  // s
    double reference_load = 0.0;  // N, 90 % yield preload: scales embedding and wear
    double static_ratio = 1.0;    // breakaway/running friction
    double breakaway_angle = 0;   // rad of sliding over which breakaway wears off
    double healing_time = 0.0;    // s of rest over which it comes back
    double wear_early = 0.0;      // friction change that saturates with the first re-uses, relative
    double wear_early_uses = 1;
    double wear_per_use = 0.0;   // and that goes on, relative per use
    double drag = 0.0;           // N·m, prevailing torque
    double running = 0.0;        // N·m, mean drag of the free thread
    double weight_lead = 0.0;    // N·m, weight of the nut along the lead: negative when it helps tightening
    double weight_friction = 0;  // N·m
    double ripple_phase[3] = {0.0, 0.0, 0.0};  // of the running drag over the angle
};

// `random` gives this bolt its friction and its drag's ripple. Equal seeds give equal bolts.
// `own` is what the flange gives under this joint alone, m/N; 0 for a joint by itself.
MechanisticParameters derive(const JointDesign& design, Random& random, double own = 0.0);

struct MechanisticState {
    double angle = 0.0;       // rad, nut from hand-started
    double plastic = 0.0;     // m, permanent elongation of the bolt, never falls
    double stripped = 0.0;    // m, travel of sheared nut threads, never falls
    double embedding = 0.0;   // m, flattened roughness, never falls
    double uses = 0.0;        // tightenings to the reference load that the faces have been through
    double dwell = 1.0;       // 0…1, breakaway state
    double share = 0.0;       // −1…1, how much of the friction carries torque now (+1: slides tightening)
    double clamp = 0.0;       // N
    double stiffness = 0.0;   // dF/dx of the elastic joint, N/m
    double neighbours = 0.0;  // m, closure taken up by the other joints of the group
    Stage stage = Stage::navigation;
    Condition condition = Condition::sound;
};

// Torque that the wrench must give to turn the nut on or off from here, and how it changes with the angle.
struct Resistance {
    double tighten = 0.0;        // N·m
    double loosen = 0.0;         // N·m, negative where the nut holds
    double tighten_slope = 0.0;  // N·m/rad, of the elastic joint
    double loosen_slope = 0.0;
    double lead = 0.0;  // N·m, the part that is not friction
};

Resistance resistance(const MechanisticParameters& p, const MechanisticState& s);

// The joint after the nut has been turned to `angle` in a step of `dt` with the friction share `share`. Also
// call it with an unchanged angle: embedding and yield go on at rest. Total work; no allocation; cannot fail.
void advance(const MechanisticParameters& p, MechanisticState& s, double angle, double share, double dt);

// Free closure of the seat spring at this state and angle, m (negative: gap).
double free_closure(const MechanisticParameters& p, const MechanisticState& s, double angle);

}  // namespace bolt::joint
