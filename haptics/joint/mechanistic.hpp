// The mechanistic law: one continuous state per joint for tightening and loosening, re-use, yield, stripping
// and breaking. Sources stand beside each part; our own assumptions are marked (ours). All SI.
//
//   x   closure, m: how far the elastic parts are pressed together; negative while there is a gap.
//       x = P θ/2π − start gap − plastic − stripped − embedding − neighbour closure
//       θ is the nut's angle, P the pitch; the other terms are members of MechanisticState and
//       MechanisticParameters
//   F   clamp force, a function of x (seat_spring.hpp) with the compliance δ of VDI 2230 (design.hpp)
//   T   torque: T = F P/2π ± r (F (μ_G r_t/cos β + μ_K r_b) + thread drag)  (design.hpp, Motosh)
//       μ_G, r_t, β: friction coefficient, mean radius and half flank angle of the thread; μ_K, r_b: friction
//       coefficient and mean radius of the bearing face
//   r   breakaway factor on friction: r = 1 + (static ratio − 1) b. The breakaway state b, 0 … 1, rises to 1
//       at rest and falls to 0 while the nut slides
//   Y   yield: F q ≤ Y(plastic). q is the von Mises stress of tension and thread torque, divided by the
//       tensile stress alone (design.hpp); Y is the load capacity (PlasticCurve)
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "engine/base/random.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/fastener.hpp"
#include "haptics/joint/seat_spring.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::joint {

// Load capacity of the threaded part of a bolt as a function of its plastic elongation u: from the elastic
// limit via R_p0.2 to R_m at uniform elongation u_u, then necking until fracture at u_f.
//
//   Y(u) = L_e + (L_m − L_e) (1 − e^{−(u/u_c)^¾}) / (1 − e^{−(u_u/u_c)^¾})    up to u_u
//
// This is Voce hardening with an exponent below one. Its slope is infinite at u = 0, so the torque curve
// bends into yield without a kink. The scale u_c is fitted so that the load at 0.2 % plastic strain is
// R_p0.2 · A_s, where A_s is the stress area of the thread. The form is ours. It is fitted to the elastic
// limit, R_p0.2 and R_m of ISO 898-1; the uniform elongation is half the elongation after fracture.
struct PlasticCurve {
    double elastic_load = 0.0;   // L_e, N, at u = 0: elastic limit times A_s
    double ultimate_load = 0.0;  // L_m, N, at u = u_u
    double scale = 0.0;          // u_c, m
    double uniform = 0.0;        // u_u, m
    double hardening_scale = 0.0;  // factor that scales the hardening to 1 at u_u: 1 / (1 − e^{−(u_u/u_c)^¾})
    double fracture = 0.0;         // u_f > u_u, m
    double neck_load = 0.0;        // N, at u_f, just before fracture

    // `length`: plastic length (free thread and half the engaged thread), m. `compliance`: of the joint, m/N.
    // While a bolt necks, −dY/du is at most half of 1/compliance, the slope at which the elastic joint
    // unloads. A steeper fall would give several loads for one nut angle.
    static PlasticCurve make(const ScrewThread& thread, const PropertyClass& bolt, double length,
                             double compliance);

    struct LoadSlope {
        double load = 0.0;   // Y(u), N
        double slope = 0.0;  // dY/du, N/m; +∞ at u = 0
    };
    [[nodiscard]] LoadSlope at(double elongation) const {
        constexpr double infinity = std::numeric_limits<double>::infinity();
        return elongation <= 0.0 ? LoadSlope{elastic_load, infinity} : plastic_at(elongation);
    }

  private:
    [[nodiscard]] LoadSlope plastic_at(double elongation) const;  // elongation > 0
};

struct MechanisticParameters {
    ScrewThread thread;
    TorqueLevers levers;     // m, torque per clamp force of this bolt, with scatter and without wear
    double mu_thread = 0.0;  // μ_G of this bolt, with scatter and without wear
    double kappa = 1.5;      // factor of the torsion in the equivalent stress (PropertyClass::kappa)
    double start_gap = 0.0;  // m, nut face to seat at angle 0
    SeatSpring seat;
    PlasticCurve bolt;
    double strip_load = 0.0;         // N, axial load at which the threads in the nut or hole shear
    double strip_length = 0.0;       // m of travel until the threads are sheared off completely
    double flow_time = 0.0;          // s, time constant of plastic flow (flow() in mechanistic.cpp)
    double embedding = 0.0;          // m, f_Z of VDI 2230, at the reference load and above
    double embedding_time = 0.0;     // s, time constant of embedding
    double reference_load = 0.0;     // N, preload at 90 % yield; scales embedding and wear
    double static_ratio = 1.0;       // breakaway/running friction
    double breakaway_angle = 0;      // rad of sliding over which breakaway wears off
    double healing_time = 0.0;       // s of rest over which it recovers
    double wear_early = 0.0;         // relative change of friction that saturates over the first re-uses
    double wear_early_uses = 1;      // re-uses; scale on which that change saturates exponentially
    double wear_per_use = 0.0;       // relative change of friction with every use, without end
    double prevailing_torque = 0.0;  // N·m, of a locking nut in its first use
    double insert_angle = 0.0;  // rad, nut angle at which the bolt's end reaches a locking insert; 0: none
    double insert_ramp = 1.0;   // rad over which the bolt's end then enters the insert
    double insert_wear = 1.0;   // factor on the insert's torque with every use
    double running_drag = 0.0;  // N·m, mean drag of the free thread
    double weight_lead =
        0.0;  // N·m, torque of the nut's weight on the thread's slope; negative: it helps tightening
    double weight_friction = 0;  // N·m, friction of the nut's weight on the thread
    // rad, phases of the three sine waves by which the running drag fluctuates with the angle.
    double ripple_phase[3] = {0.0, 0.0, 0.0};
    // True: only friction or a second wrench keeps the held part from turning (CounterHold::second_wrench).
    // False: it cannot turn, and the next two members are 0.
    bool held_part_can_turn = false;
    double held_lever = 0.0;  // m, μ r_b under the held part
    double held_drag = 0.0;   // N·m, friction of the bolt's weight under the held part
};

// `random` determines this bolt's friction and the ripple of its drag; equal seeds give equal bolts.
// `own_compliance`: compliance of the flange under this joint alone, m/N; 0 for a single joint.
MechanisticParameters derive(const JointDesign& design, Random& random, double own_compliance = 0.0);

// N·m, of an unused locking nut at this angle (rad). A non-metallic insert acts once the bolt's end has
// reached it.
inline double prevailing_torque(const MechanisticParameters& p, double angle) {
    if (p.insert_angle <= 0.0) return p.prevailing_torque;
    return p.prevailing_torque * std::clamp((angle - p.insert_angle) / p.insert_ramp, 0.0, 1.0);
}

struct MechanisticState {
    double angle = 0.0;      // rad, of the nut; 0 where the hand starts it on its thread
    double plastic = 0.0;    // m, permanent elongation of the bolt, never falls
    double stripped = 0.0;   // m, travel of the sheared threads, never falls
    double embedding = 0.0;  // m, flattened roughness, never falls
    double uses = 0.0;       // tightenings so far; a tightening to half the reference load counts as 0.5
    double breakaway = 1.0;  // 0…1, breakaway state
    double friction_share = 0.0;  // −1…1, friction torque ÷ its maximum; +1: slides tightening, −1: loosening
    double clamp = 0.0;           // N
    double stiffness = 0.0;          // dF/dx of the elastic joint, N/m
    double neighbour_closure = 0.0;  // m by which the other joints of the group press the flange down here
    Stage stage = Stage::navigation;
    JointCondition condition = JointCondition::intact;
};

// Torque that tightens or loosens the nut from the present state, and its slope over the angle.
struct Resistance {
    double tighten = 0.0;  // N·m
    double loosen =
        0.0;  // N·m; negative: this torque must be applied to loosen it; positive: it would turn by itself
    double tighten_slope = 0.0;  // N·m/rad, of the elastic joint
    double loosen_slope = 0.0;   // N·m/rad, likewise
    double lead_torque = 0.0;    // N·m, the part that is not friction
};

// The resistance while the nut turns on the thread and the bolt does not turn.
Resistance resistance(const MechanisticParameters& p, const MechanisticState& s);

// The resistance while nut and bolt turn together: the faces under nut and head slide, the thread does not,
// and the clamp force is constant. All faces of a joint share one breakaway state (docs/decisions.md).
// `hold`: external torque on the held part, N·m.
Resistance resistance_together(const MechanisticParameters& p, const MechanisticState& s, double hold);

// The motion of a nut in a step.
struct NutTurn {
    double angle = 0.0;           // rad, of the nut on its thread after the step (not the change)
    double friction_share = 0.0;  // −1…1, friction torque ÷ its maximum; +1: slides tightening
    double common = 0.0;          // rad by which nut and bolt have turned together in the step
};

// A time step, and the share 1 − e^(−dt/τ) of the way to its limit that a first-order process covers in it.
class TimeStep {
  public:
    explicit TimeStep(double dt) : dt_(dt) {}
    [[nodiscard]] double dt() const { return dt_; }  // s

    // For the time constant τ of embedding or of the recovery of breakaway, s. The joints of a group mostly
    // have the same ones, so the exponentials of the joint before are used again.
    double embedding(double time) { return share(embedding_, time); }
    double healing(double time) { return share(healing_, time); }

  private:
    struct Share {
        double time = -1.0;  // s; negative: none yet
        double value = 0.0;
    };
    double share(Share& last, double time) const {
        if (time != last.time) last = {time, -std::expm1(-dt_ / time)};
        return last.value;
    }

    double dt_ = 0.0;
    Share embedding_, healing_;
};

// Advances the joint by a time step after the nut has turned. Call it with an unchanged angle too, because
// embedding and yield continue at rest. No allocation; cannot fail.
void advance(const MechanisticParameters& p, MechanisticState& s, const NutTurn& turn, TimeStep& step);
inline void advance(const MechanisticParameters& p, MechanisticState& s, const NutTurn& turn, double dt) {
    TimeStep step(dt);
    advance(p, s, turn, step);
}

// The closure x (m, as above) if the nut were at `angle` (rad) and everything else as in `s`.
double closure_at_angle(const MechanisticParameters& p, const MechanisticState& s, double angle);

}  // namespace bolt::joint
