#include "haptics/joint/mechanistic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/joint/design.hpp"

namespace bolt::joint {

namespace {

double power_3_4(double x) { return std::sqrt(x * std::sqrt(x)); }  // x^¾

double hardening(double u, double scale) { return -std::expm1(-power_3_4(u / scale)); }

// Solves hardening(u_p)/hardening(u_u) = share for u_c by bisection. The ratio decreases monotonically with
// u_c, from 1 to (u_p/u_u)^¾.
double fit_scale(double u_p, double u_u, double share) {
    double low = std::log(u_u * 1e-6), high = std::log(u_u * 1e6);
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        const double scale = std::exp(middle);
        (hardening(u_p, scale) / hardening(u_u, scale) > share ? low : high) = middle;
    }
    return std::exp(0.5 * (low + high));
}

}  // namespace

PlasticCurve PlasticCurve::make(const ScrewThread& thread, const PropertyClass& bolt, double length,
                                double compliance) {
    PlasticCurve c;
    c.elastic_load = bolt.proof_ratio * bolt.R_p02 * thread.A_s;
    c.ultimate_load = bolt.R_m * thread.A_s;
    c.uniform = 0.5 * bolt.fracture_strain * length;
    const double u_p = 0.002 * length;
    const double share = (bolt.R_p02 * thread.A_s - c.elastic_load) / (c.ultimate_load - c.elastic_load);
    c.scale = fit_scale(u_p, c.uniform, share);
    c.hardening_scale = 1.0 / hardening(c.uniform, c.scale);
    c.neck_load = 0.8 * c.ultimate_load;
    const double drop = c.ultimate_load - c.neck_load;
    c.fracture = c.uniform + std::max(0.5 * bolt.fracture_strain * length, 2.0 * drop * compliance);
    return c;
}

PlasticCurve::LoadSlope PlasticCurve::plastic_at(double u) const {
    if (u < uniform) {
        const double x = power_3_4(u / scale);
        const double hardened = -std::expm1(-x);
        const double span = (ultimate_load - elastic_load) * hardening_scale;
        return {elastic_load + span * hardened, span * (1.0 - hardened) * 0.75 * x / u};
    }
    if (u >= fracture) return {0.0, 0.0};
    const double slope = -(ultimate_load - neck_load) / (fracture - uniform);
    return {ultimate_load + slope * (u - uniform), slope};
}

namespace {

constexpr double gravity = 9.81;          // m/s²
constexpr double steel_density = 7850.0;  // kg/m³

// Numbers of loaded threads, of bearing faces under head and nut, and of interfaces between members.
struct EmbeddingFaces {
    int threads = 1, bearings = 2, interfaces = 0;
};
// m, VDI 2230-1 table 5, for shear-loaded joints.
double embedding_amount(double Rz, const EmbeddingFaces& faces) {
    struct EmbeddingRow {
        double thread, bearing, interface;
    };
    const EmbeddingRow row = Rz < 10e-6   ? EmbeddingRow{3.0, 3.0, 2.0}
                             : Rz < 40e-6 ? EmbeddingRow{3.0, 4.5, 2.5}
                                          : EmbeddingRow{3.0, 6.5, 3.5};
    return 1e-6 *
           (faces.threads * row.thread + faces.bearings * row.bearing + faces.interfaces * row.interface);
}

struct Wear {
    double early, early_uses, per_use;
};

// Friction over re-use. Signs and sizes after the M8 series of Acta Polytechnica Hungarica 21(2) (2024)
// 133–150: oiled faces run in within two or three tightenings, dry faces gall from the first one on, MoS2
// wears off steadily.
Wear wear_of(Lubrication lubrication) {
    switch (lubrication) {
        case Lubrication::dry:
            return {0.12, 2.0, 0.009};
        case Lubrication::oiled:
            return {-0.20, 1.5, 0.0};
        case Lubrication::mos2:
            return {0.0, 1.0, 0.05};
        case Lubrication::as_received:
            break;
    }
    return {-0.05, 2.0, 0.025};
}

// The coefficients of a design are those of the first tightening; wear sets in smoothly from the second one
// on.
double wear_factor(const MechanisticParameters& p, double all_uses) {
    const double again = all_uses - 1.0;
    if (again <= 0.0) return 1.0;
    const double uses = again * again / (again + 0.5);
    return 1.0 + p.wear_early * (1.0 - std::exp(-uses / p.wear_early_uses)) + p.wear_per_use * uses;
}

// Drag of the free thread: it rises from zero as the nut starts and then fluctuates with the angle, as in
// measured runs.
double running_drag_at(const MechanisticParameters& p, double angle) {
    const double start = angle < 20.0 ? -std::expm1(-std::max(angle, 0.0) / 0.5) : 1.0;  // 1 − e⁻⁴⁰ is 1
    const double ripple = 0.25 * std::sin(angle + p.ripple_phase[0]) +
                          0.15 * std::sin(2.3 * angle + p.ripple_phase[1]) +
                          0.10 * std::sin(5.1 * angle + p.ripple_phase[2]);
    return p.running_drag * start * (1.0 + ripple);
}

// kg, of a nut, or of a whole screw.
double turned_mass(const JointDesign& design) {
    const ScrewThread& thread = design.thread.thread;
    const TurnedPartSize part = turned_part_size(design);
    const double hexagon = 0.5 * std::sqrt(3.0) * square(part.across_flats);
    if (design.turned == TurnedPart::nut)
        return steel_density * (hexagon - 0.25 * pi * square(thread.d2)) * part.height;
    const SocketHead* const socket = part.depth > 0.0 ? socket_head(design.thread.size.name) : nullptr;
    const double head = socket ? 0.25 * pi * square(socket->diameter) * part.height - hexagon * part.depth
                               : hexagon * part.height;
    return steel_density * (head + 0.25 * pi * square(thread.d2) * design.bolt_length);
}

// Prevailing torque of a nut that may have been used before. A non-metallic insert wears.
double prevailing_torque_at(const MechanisticParameters& p, const MechanisticState& s) {
    const double first_use = prevailing_torque(p, s.angle);
    if (p.insert_angle <= 0.0) return first_use;
    return first_use * std::pow(p.insert_wear, std::max(0.0, s.uses - 1.0));
}

// An iterate of the search for the balance between the elastic joint and its load capacity.
struct BalanceIterate {
    double force = 0.0;     // N
    double closure = 0.0;   // m
    double gradient = 0.0;  // dx/dF, m/N
    double excess = 0.0;    // N above the capacity
    double slope = 1.0;     // d(excess)/dF
};

BalanceIterate make_iterate(const SeatSpring& seat, double force) {
    return {force, seat.closure(force), seat.compliance + seat.scale / force};
}

// The closure of the seat at zero excess, between the force `low` and the iterate `at` above it; the excess
// increases with the force. Newton's method with a bracket, bisecting where Newton leaves it, with a fixed
// bound of iterations. `evaluate` computes excess and slope.
template <class Evaluate>
double balanced_closure(const SeatSpring& seat, double low, BalanceIterate at, const Evaluate& evaluate) {
    double high = at.force;
    evaluate(at);
    for (int i = 0;; ++i) {
        (at.excess > 0.0 ? high : low) = at.force;
        const double newton = at.force - at.excess / at.slope;
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        // Newton converges quadratically, so the remaining relative error is below 1e-10, as is the effect of
        // the closure's curvature.
        if (i == 24 || std::abs(next - at.force) <= 1e-5 * high)
            return at.closure + at.gradient * (next - at.force);
        at = make_iterate(seat, next);
        evaluate(at);
    }
}

// Load capacity of the joint.
struct Capacity {
    double ratio = 1.0;            // equivalent over tensile stress
    PlasticCurve::LoadSlope bolt;  // equivalent load and its slope at the present plastic elongation
    double strip = 0.0;            // N, of the threads in the nut or hole

    [[nodiscard]] double force() const { return std::min(bolt.load / ratio, strip); }
};

// Plastic flow of the bolt, or shearing of the threads in the nut or hole, whichever is weaker.
// Rate-independent plasticity would kink the torque when a loaded joint starts to flow again, so the flow
// follows the rate-independent solution with a short time constant (Duvaut and Lions 1972). The slope is then
// continuous on every path. Dissipation is positive, because the bolt elongates plastically only while F > 0.
void flow(const MechanisticParameters& p, MechanisticState& s, double closure, const Capacity& capacity,
          double dt) {
    const double progress = -std::expm1(-dt / p.flow_time);
    const BalanceIterate start{s.clamp, closure, 1.0 / s.stiffness};

    if (capacity.strip < capacity.bolt.load / capacity.ratio) {
        // Balance of the force F and the travel d of the sheared threads: F = strip_load (1 − d/strip_length)
        // and closure − (d − stripped) = seat.closure(F).
        const double slope = p.strip_load / p.strip_length;
        const auto evaluate = [&](BalanceIterate& t) {
            t.excess = t.force - (p.strip_load - slope * (s.stripped + closure - t.closure));
            t.slope = std::max(1.0 - slope * t.gradient, 1e-3);
        };
        const double rest = balanced_closure(p.seat, 1e-3 * p.seat.touch_force, start, evaluate);
        s.stripped += progress * std::max(0.0, closure - rest);
        s.condition = JointCondition::stripped;
        return;
    }
    const auto evaluate = [&](BalanceIterate& t) {
        // Without plastic elongation the slope is infinite, which would stop Newton's method.
        const double set = std::max(s.plastic + (closure - t.closure), 1e-12);
        const PlasticCurve::LoadSlope y = set == s.plastic ? capacity.bolt : p.bolt.at(set);
        t.excess = capacity.ratio * t.force - y.load;
        t.slope = capacity.ratio + t.gradient * y.slope;
    };
    const double low = 0.5 * std::min(capacity.bolt.load, p.bolt.neck_load) / capacity.ratio;
    s.plastic += progress * std::max(0.0, closure - balanced_closure(p.seat, low, start, evaluate));
    if (s.plastic >= p.bolt.fracture) s.condition = JointCondition::broken;
}

Stage stage_of(const MechanisticParameters& p, const MechanisticState& s, double ratio,
               const PlasticCurve::LoadSlope& bolt) {
    if (s.clamp < p.seat.touch_force) return Stage::navigation;
    if (s.condition == JointCondition::stripped) return Stage::yield;
    const double linear = 1.0 / p.seat.compliance;
    if (ratio * s.clamp >= 0.999 * bolt.load) {
        // Yield-controlled tightening stops where the gradient has fallen to half; the yield stage begins at
        // the same point.
        const double tangent = bolt.slope > 0.0 ? 1.0 / (p.seat.compliance + ratio / bolt.slope) : 0.0;
        if (tangent < 0.5 * linear) return Stage::yield;
    }
    return s.stiffness < 0.75 * linear ? Stage::transition : Stage::linearity;
}

// The insert fills the last third of the nut (ours), behind the metal thread. Its torque reaches the full
// value three pitches after the bolt's end has reached the insert. At angle 0 the nut is `start_gap` above
// its seat, so the bolt's end is `start_gap` less deep in the nut than with the nut on its seat. The wear
// between two uses follows from the smallest torques that ISO 2320 allows at the first and the fifth removal.
void derive_insert(const JointDesign& design, MechanisticParameters& p) {
    const LockingNut* const nut = design.locking_insert ? locking_nut(design.thread.size.name) : nullptr;
    if (!nut) return;
    const double at_seat = design.bolt_length - design.grip_length();  // m of the bolt above the seat
    const double travel = design.start_gap + 2.0 / 3.0 * nut->height - at_seat;
    p.insert_angle = std::max(travel / p.levers.lead, 1e-9);
    p.insert_ramp = 3.0 * p.thread.pitch / p.levers.lead;
    p.insert_wear = std::pow(nut->least_off_5th / nut->least_off, 0.25);
}

// Draws from `random` last, and only if the held part can turn, so that a joint has the same other values
// with and without a part that can turn. The bolt's weight rests on its head, or in its hole if the bolt is
// level. The friction radius d/2 is our value between the radii of head and hole.
void derive_held_part(const JointDesign& design, Random& random, MechanisticParameters& p) {
    p.held_part_can_turn = design.counter_hold == CounterHold::second_wrench;
    if (!p.held_part_can_turn) return;
    const double scatter = std::max(0.3, 1.0 + design.friction.scatter * random.normal());
    const double mu = design.friction.held_bearing.value_or(design.friction.bearing) * scatter;
    const FastenerSize& size = design.thread.size;
    p.held_lever = 0.5 * mu * bearing_mean_diameter(held_part_size(design).bearing, size.hole);
    const double hexagon = 0.5 * std::sqrt(3.0) * square(size.across_flats) * size.head_height;
    const double shank = 0.25 * pi * square(p.thread.d2) * design.bolt_length;
    p.held_drag = 0.5 * size.d * mu * gravity * steel_density * (hexagon + shank);
}

}  // namespace

MechanisticParameters derive(const JointDesign& design, Random& random, double own_compliance) {
    const FastenerSize& size = design.thread.size;
    MechanisticParameters p;
    p.thread = design.thread.thread;

    // Thread and bearing scatter independently, because they are different faces.
    const double thread_scatter = std::max(0.3, 1.0 + design.friction.scatter * random.normal());
    const double bearing_scatter = std::max(0.3, 1.0 + design.friction.scatter * random.normal());
    p.mu_thread = design.friction.thread * thread_scatter;
    p.levers = torque_levers(p.thread, p.mu_thread, design.friction.bearing * bearing_scatter,
                             design.bearing_diameter());
    p.kappa = design.bolt_class.kappa;
    p.start_gap = design.start_gap;

    const double h_rms = design.roughness_Rz / 5.5;  // usual for turned and milled faces
    const double seat_area = 0.25 * pi * (square(turned_part_size(design).bearing) - square(size.hole));
    p.seat = {.compliance = joint_compliance(design) + own_compliance,
              .scale = 0.5 * h_rms + design.misfit,
              .touch_force = 0.2e6 * seat_area};  // 0.2 MPa, at which fingers feel the seat; ours

    const double free_thread =
        std::max(0.0, design.grip_length() - (design.bolt_length - design.thread_on_bolt()));
    p.bolt = PlasticCurve::make(p.thread, design.bolt_class, free_thread + 0.5 * size.d, p.seat.compliance);

    // A nut of the matching class is stronger than the bolt (ISO 898-2): its proof load exceeds the bolt's
    // tensile load.
    const double nut_stress = design.nut_strength > 0.0 ? design.nut_strength : 1.15 * design.bolt_class.R_m;
    p.strip_load = nut_stress * p.thread.A_s;
    p.strip_length = 0.75 * size.nut_height;
    if (design.is_tapped()) {
        const double hole =
            stripping_forces(p.thread, design.bolt_class, design.hole.material, design.hole.engagement)
                .least();
        // The nut of a stud may be the weaker of the two.
        if (design.form == JointForm::tapped_hole || hole < p.strip_load) {
            p.strip_load = hole;
            p.strip_length = 0.75 * design.hole.engagement;
        }
    }
    p.flow_time = 0.005;

    const int layers = static_cast<int>(design.members.size()) + (design.washer_under_head ? 1 : 0) +
                       (design.washer_under_nut ? 1 : 0);
    // A tapped part is one more layer, and has no bearing face. A stud has two loaded threads.
    const EmbeddingFaces faces = design.is_tapped()
                                     ? EmbeddingFaces{design.form == JointForm::stud ? 2 : 1, 1, layers}
                                     : EmbeddingFaces{1, 2, std::max(0, layers - 1)};
    p.embedding = embedding_amount(design.roughness_Rz, faces);
    p.embedding_time = design.embedding_time;
    p.reference_load = 0.9 * design.bolt_class.R_p02 * p.thread.A_s /
                       equivalent_stress_ratio(p.thread, design.friction.thread, p.kappa);

    p.static_ratio = design.friction.static_ratio;
    p.breakaway_angle = to_radians(2.0);
    p.healing_time = 0.3;
    const Wear wear = wear_of(design.friction.lubrication);
    p.wear_early = wear.early;
    p.wear_early_uses = wear.early_uses;
    p.wear_per_use = wear.per_use;

    p.prevailing_torque = design.prevailing_torque;
    derive_insert(design, p);
    p.running_drag = design.running_drag;
    const double weight = gravity * (design.nut_mass > 0.0 ? design.nut_mass : turned_mass(design));
    p.weight_lead = -weight * design.axis.y * p.levers.lead;
    p.weight_friction = weight * std::abs(design.axis.y) * p.levers.thread;
    for (double& phase : p.ripple_phase) phase = random.uniform(0.0, 2.0 * pi);
    derive_held_part(design, random, p);
    return p;
}

Resistance resistance(const MechanisticParameters& p, const MechanisticState& s) {
    const double breakaway_factor = 1.0 + (p.static_ratio - 1.0) * s.breakaway;
    const double friction_lever = p.levers.friction() * wear_factor(p, s.uses) * breakaway_factor;
    const double drag =
        (prevailing_torque_at(p, s) + running_drag_at(p, s.angle) + p.weight_friction) * breakaway_factor;
    const double rate = s.stiffness * p.levers.lead;  // dF/dθ, N/rad: dx/dθ = P/2π
    Resistance r;
    r.lead_torque = s.clamp * p.levers.lead + p.weight_lead;
    r.tighten = r.lead_torque + s.clamp * friction_lever + drag;
    r.loosen = r.lead_torque - s.clamp * friction_lever - drag;
    r.tighten_slope = rate * (p.levers.lead + friction_lever);
    r.loosen_slope = rate * (p.levers.lead - friction_lever);
    return r;
}

Resistance resistance_together(const MechanisticParameters& p, const MechanisticState& s, double hold) {
    const double breakaway_factor = 1.0 + (p.static_ratio - 1.0) * s.breakaway;
    const double lever = (p.levers.bearing + p.held_lever) * wear_factor(p, s.uses);
    Resistance r;
    r.tighten = (s.clamp * lever + p.held_drag) * breakaway_factor + hold;
    r.loosen = -r.tighten;
    return r;
}

double closure_at_angle(const MechanisticParameters& p, const MechanisticState& s, double angle) {
    return p.levers.lead * angle - p.start_gap - s.plastic - s.stripped - s.embedding - s.neighbour_closure;
}

void advance(const MechanisticParameters& p, MechanisticState& s, const NutTurn& turn, TimeStep& step) {
    const double angle = turn.angle, friction_share = turn.friction_share;
    const double turned = std::abs(angle - s.angle) + std::abs(turn.common);
    // Exponentials are computed only where they have an effect: most joints rest unloaded in most ticks.
    if (turned > 0.0)
        s.breakaway *= std::exp(-turned / p.breakaway_angle);
    else if (s.breakaway < 1.0)
        s.breakaway += (1.0 - s.breakaway) * step.healing(p.healing_time);
    const double clamp_before = s.clamp;
    s.angle = angle;
    s.friction_share = friction_share;

    const double final_embedding = p.embedding * std::min(1.0, s.clamp / p.reference_load);
    if (final_embedding > s.embedding)
        s.embedding += step.embedding(p.embedding_time) * (final_embedding - s.embedding);

    if (s.condition == JointCondition::broken) {
        s.clamp = s.stiffness = 0.0;
        s.stage = Stage::navigation;
        return;
    }
    SeatSpring::Load load = p.seat.at(closure_at_angle(p, s, angle), s.clamp);
    s.clamp = load.force;
    s.stiffness = load.stiffness;
    Capacity capacity;
    capacity.ratio = equivalent_stress_ratio(p.thread, p.mu_thread, p.kappa, friction_share);
    capacity.bolt = p.bolt.at(s.plastic);
    capacity.strip = p.strip_load * std::max(0.0, 1.0 - s.stripped / p.strip_length);
    if (s.clamp > capacity.force()) {
        const double closure = closure_at_angle(p, s, angle);
        flow(p, s, closure, capacity, step.dt());
        const double force_change = load.stiffness * (closure_at_angle(p, s, angle) - closure);
        load = s.condition == JointCondition::broken
                   ? SeatSpring::Load{}
                   : p.seat.at(closure_at_angle(p, s, angle), load.force + force_change);
        s.clamp = load.force;
        s.stiffness = load.stiffness;
        capacity.bolt = p.bolt.at(s.plastic);
    }
    // One use of the faces is one increase of the clamp force to the reference load by turning, in any number
    // of pulls.
    if (turned > 0.0) s.uses += std::max(0.0, s.clamp - clamp_before) / p.reference_load;
    s.stage = stage_of(p, s, capacity.ratio, capacity.bolt);
}

}  // namespace bolt::joint
