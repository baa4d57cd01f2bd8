#include "haptics/joint/mechanistic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "haptics/joint/design.hpp"

namespace bolt::joint {

namespace {

double power(double x) { return std::sqrt(x * std::sqrt(x)); }  // x^¾

double rise(double u, double scale) { return -std::expm1(-power(u / scale)); }

// u_c with rise(u_p)/rise(u_u) = share. The ratio falls monotonically as u_c grows, from 1 to (u_p/u_u)^¾.
double fit_scale(double u_p, double u_u, double share) {
    double low = std::log(u_u * 1e-6), high = std::log(u_u * 1e6);
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        const double scale = std::exp(middle);
        (rise(u_p, scale) / rise(u_u, scale) > share ? low : high) = middle;
    }
    return std::exp(0.5 * (low + high));
}

}  // namespace

PlasticCurve PlasticCurve::make(const Thread& thread, const PropertyClass& bolt, double length,
                                double compliance) {
    PlasticCurve c;
    c.elastic_load = bolt.proof_ratio * bolt.R_p02 * thread.A_s;
    c.ultimate_load = bolt.R_m * thread.A_s;
    c.uniform = 0.5 * bolt.fracture_strain * length;
    const double u_p = 0.002 * length;
    const double share = (bolt.R_p02 * thread.A_s - c.elastic_load) / (c.ultimate_load - c.elastic_load);
    c.scale = fit_scale(u_p, c.uniform, share);
    c.spread = 1.0 / rise(c.uniform, c.scale);
    c.neck_load = 0.8 * c.ultimate_load;
    const double drop = c.ultimate_load - c.neck_load;
    c.fracture = c.uniform + std::max(0.5 * bolt.fracture_strain * length, 2.0 * drop * compliance);
    return c;
}

PlasticCurve::Point PlasticCurve::at(double u) const {
    if (u <= 0.0) return {elastic_load, std::numeric_limits<double>::infinity()};
    if (u < uniform) {
        const double x = power(u / scale);
        const double risen = -std::expm1(-x);
        const double span = (ultimate_load - elastic_load) * spread;
        return {elastic_load + span * risen, span * (1.0 - risen) * 0.75 * x / u};
    }
    if (u >= fracture) return {0.0, 0.0};
    const double slope = -(ultimate_load - neck_load) / (fracture - uniform);
    return {ultimate_load + slope * (u - uniform), slope};
}

namespace {

constexpr double gravity = 9.81;  // m/s²
constexpr double steel_density = 7850.0;

// VDI 2230-1 table 5, shear-loaded joints, metres: thread; each of head and nut; each inner interface.
double embedding_amount(double Rz, int interfaces) {
    struct Row {
        double thread, bearing, interface;
    };
    const Row row = Rz < 10e-6 ? Row{3.0, 3.0, 2.0} : Rz < 40e-6 ? Row{3.0, 4.5, 2.5} : Row{3.0, 6.5, 3.5};
    return 1e-6 * (row.thread + 2.0 * row.bearing + interfaces * row.interface);
}

struct Wear {
    double early, early_uses, per_use;
};

// Friction over re-use. Signs and sizes after the M8 series of Acta Polytechnica Hungarica 21(2) (2024)
// 133–150: oiled faces run in within two or three tightenings, dry ones gall at once and go on, MoS2 is used
// up steadily.
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

// The coefficients of a design are those of the first tightening; wear shows from the second on, and comes in
// smoothly.
double wear_factor(const MechanisticParameters& p, double all_uses) {
    const double again = all_uses - 1.0;
    if (again <= 0.0) return 1.0;
    const double uses = again * again / (again + 0.5);
    return 1.0 + p.wear_early * (1.0 - std::exp(-uses / p.wear_early_uses)) + p.wear_per_use * uses;
}

// Drag of the free thread: it rises from nothing as the nut starts and then wavers with the angle, as
// measured runs do.
double running_drag(const MechanisticParameters& p, double angle) {
    const double start = angle < 20.0 ? -std::expm1(-std::max(angle, 0.0) / 0.5) : 1.0;  // 1 − e⁻⁴⁰ is 1
    const double ripple = 0.25 * std::sin(angle + p.ripple_phase[0]) +
                          0.15 * std::sin(2.3 * angle + p.ripple_phase[1]) +
                          0.10 * std::sin(5.1 * angle + p.ripple_phase[2]);
    return p.running * start * (1.0 + ripple);
}

double nut_mass(const FastenerSize& size, const Thread& thread) {
    const double hexagon = 0.5 * std::sqrt(3.0) * square(size.across_flats) - 0.25 * pi * square(thread.d2);
    return steel_density * hexagon * size.nut_height;
}

// A point on the way to where the elastic joint and its load capacity meet: a force, the closure that makes
// it, and how far it is out of balance.
struct Trial {
    double force = 0.0;     // N
    double closure = 0.0;   // m
    double gradient = 0.0;  // dx/dF, m/N
    double excess = 0.0;    // N above the capacity
    double slope = 1.0;     // d(excess)/dF
};

Trial trial(const SeatSpring& seat, double force) {
    return {force, seat.closure(force), seat.compliance + seat.scale / force};
}

// The closure of the seat where the excess is zero, between the force `low` and the trial `at` above it; the
// excess increases with the force. Newton kept inside a shrinking bracket; the count is fixed, so it ends,
// and the bracket halves where Newton does not do better, so it is right when it ends. `weigh` fills in
// excess and slope.
template <class Weigh>
double closure_in_balance(const SeatSpring& seat, double low, Trial at, const Weigh& weigh) {
    double high = at.force;
    weigh(at);
    for (int i = 0;; ++i) {
        (at.excess > 0.0 ? high : low) = at.force;
        const double newton = at.force - at.excess / at.slope;
        const double next = newton > low && newton < high ? newton : 0.5 * (low + high);
        // Newton is quadratic: what is left is below 1e-10, and so is the curvature of the closure.
        if (i == 24 || std::abs(next - at.force) <= 1e-5 * high)
            return at.closure + at.gradient * (next - at.force);
        at = trial(seat, next);
        weigh(at);
    }
}

// What the joint can carry now.
struct Capacity {
    double ratio = 1.0;        // equivalent over tensile stress
    PlasticCurve::Point bolt;  // equivalent load and its slope at the present set
    double strip = 0.0;        // N, of the nut's threads

    [[nodiscard]] double force() const { return std::min(bolt.load / ratio, strip); }
};

// Plastic flow of the bolt, or shearing of the nut's threads, whichever is weaker. Rate-independent
// plasticity would kink the torque when a loaded joint starts to flow again, so the flow follows its
// rate-independent solution with a short time constant (Duvaut and Lions 1972): the slope stays continuous on
// every path, and what is dissipated stays positive because the set only grows while F > 0.
void flow(const MechanisticParameters& p, MechanisticState& s, double closure, const Capacity& capacity,
          double dt) {
    const double progress = -std::expm1(-dt / p.flow_time);
    const Trial start{s.clamp, closure, 1.0 / s.stiffness};

    if (capacity.strip < capacity.bolt.load / capacity.ratio) {
        // F = S0 (1 − t/L) and closure − (t − stripped) = seat(F).
        const double slope = p.strip_load / p.strip_length;
        const auto weigh = [&](Trial& t) {
            t.excess = t.force - (p.strip_load - slope * (s.stripped + closure - t.closure));
            t.slope = std::max(1.0 - slope * t.gradient, 1e-3);
        };
        const double rest = closure_in_balance(p.seat, 1e-3 * p.seat.touch_force, start, weigh);
        s.stripped += progress * std::max(0.0, closure - rest);
        s.condition = Condition::stripped;
        return;
    }
    const auto weigh = [&](Trial& t) {
        // At no set at all the slope is infinite and would stop Newton.
        const double set = std::max(s.plastic + (closure - t.closure), 1e-12);
        const PlasticCurve::Point y = set == s.plastic ? capacity.bolt : p.bolt.at(set);
        t.excess = capacity.ratio * t.force - y.load;
        t.slope = capacity.ratio + t.gradient * y.slope;
    };
    const double low = 0.5 * std::min(capacity.bolt.load, p.bolt.neck_load) / capacity.ratio;
    s.plastic += progress * std::max(0.0, closure - closure_in_balance(p.seat, low, start, weigh));
    if (s.plastic >= p.bolt.fracture) s.condition = Condition::broken;
}

Stage stage_of(const MechanisticParameters& p, const MechanisticState& s, double ratio,
               const PlasticCurve::Point& bolt) {
    if (s.clamp < p.seat.touch_force) return Stage::navigation;
    if (s.condition == Condition::stripped) return Stage::yield;
    const double linear = 1.0 / p.seat.compliance;
    if (ratio * s.clamp >= 0.999 * bolt.load) {
        // Yield-controlled tightening cuts off where the gradient has fallen to half: the same mark here.
        const double tangent = bolt.slope > 0.0 ? 1.0 / (p.seat.compliance + ratio / bolt.slope) : 0.0;
        if (tangent < 0.5 * linear) return Stage::yield;
    }
    return s.stiffness < 0.75 * linear ? Stage::transition : Stage::linearity;
}

}  // namespace

MechanisticParameters derive(const JointDesign& design, Random& random, double own) {
    const FastenerSize& size = design.thread.size;
    MechanisticParameters p;
    p.thread = design.thread.thread;

    // Thread and bearing scatter apart: they are different faces.
    const double thread_scatter = std::max(0.3, 1.0 + design.friction.scatter * random.normal());
    const double bearing_scatter = std::max(0.3, 1.0 + design.friction.scatter * random.normal());
    p.mu_thread = design.friction.thread * thread_scatter;
    p.levers = torque_levers(p.thread, p.mu_thread, design.friction.bearing * bearing_scatter,
                             bearing_mean_diameter(size.nut_bearing, size.hole));
    p.kappa = design.bolt_class.kappa;
    p.gap = design.start_gap;

    const double h_rms = design.roughness_Rz / 5.5;  // usual for turned and milled faces
    const double seat_area = 0.25 * pi * (square(size.nut_bearing) - square(size.hole));
    p.seat = {.compliance = joint_compliance(design) + own,
              .scale = 0.5 * h_rms + design.misfit,
              .touch_force = 0.2e6 * seat_area};  // 0.2 MPa: fingers feel the seat; ours

    const double thread_l = design.bolt_thread_length > 0.0 ? design.bolt_thread_length
                                                            : thread_length(size.d, design.bolt_length);
    const double free_thread = std::max(0.0, design.grip_length() - (design.bolt_length - thread_l));
    p.bolt = PlasticCurve::make(p.thread, design.bolt_class, free_thread + 0.5 * size.d, p.seat.compliance);

    // A nut of the matching class outlives the bolt (ISO 898-2): proof load above the bolt's tensile load.
    const double nut_stress = design.nut_strength > 0.0 ? design.nut_strength : 1.15 * design.bolt_class.R_m;
    p.strip_load = nut_stress * p.thread.A_s;
    p.strip_length = 0.75 * size.nut_height;
    p.flow_time = 0.005;

    const int layers = static_cast<int>(design.members.size()) + (design.washer_under_head ? 1 : 0) +
                       (design.washer_under_nut ? 1 : 0);
    p.embedding = embedding_amount(design.roughness_Rz, std::max(0, layers - 1));
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

    p.drag = design.prevailing_torque;
    p.running = design.running_torque;
    const double weight = gravity * (design.nut_mass > 0.0 ? design.nut_mass : nut_mass(size, p.thread));
    p.weight_lead = -weight * design.axis.y * p.levers.lead;
    p.weight_friction = weight * std::abs(design.axis.y) * p.levers.thread;
    for (double& phase : p.ripple_phase) phase = random.uniform(0.0, 2.0 * pi);
    return p;
}

Resistance resistance(const MechanisticParameters& p, const MechanisticState& s) {
    const double breakaway = 1.0 + (p.static_ratio - 1.0) * s.dwell;
    const double friction_lever = p.levers.friction() * wear_factor(p, s.uses) * breakaway;
    const double drag = (p.drag + running_drag(p, s.angle) + p.weight_friction) * breakaway;
    const double rate = s.stiffness * p.levers.lead;  // dF/dθ, N/rad: dx/dθ = P/2π
    Resistance r;
    r.lead = s.clamp * p.levers.lead + p.weight_lead;
    r.tighten = r.lead + s.clamp * friction_lever + drag;
    r.loosen = r.lead - s.clamp * friction_lever - drag;
    r.tighten_slope = rate * (p.levers.lead + friction_lever);
    r.loosen_slope = rate * (p.levers.lead - friction_lever);
    return r;
}

double free_closure(const MechanisticParameters& p, const MechanisticState& s, double angle) {
    return p.levers.lead * angle - p.gap - s.plastic - s.stripped - s.embedding - s.neighbours;
}

void advance(const MechanisticParameters& p, MechanisticState& s, double angle, double share, double dt) {
    const double turned = std::abs(angle - s.angle);
    s.dwell = turned > 0.0 ? s.dwell * std::exp(-turned / p.breakaway_angle)
                           : s.dwell + (1.0 - s.dwell) * -std::expm1(-dt / p.healing_time);
    const double clamp_before = s.clamp;
    s.angle = angle;
    s.share = share;

    const double settled = p.embedding * std::min(1.0, s.clamp / p.reference_load);
    s.embedding += -std::expm1(-dt / p.embedding_time) * std::max(0.0, settled - s.embedding);

    if (s.condition == Condition::broken) {
        s.clamp = s.stiffness = 0.0;
        s.stage = Stage::navigation;
        return;
    }
    SeatSpring::Load load = p.seat.at(free_closure(p, s, angle), s.clamp);
    s.clamp = load.force;
    s.stiffness = load.stiffness;
    Capacity capacity;
    capacity.ratio = equivalent_stress_ratio(p.thread, p.mu_thread, p.kappa, share);
    capacity.bolt = p.bolt.at(s.plastic);
    capacity.strip = p.strip_load * std::max(0.0, 1.0 - s.stripped / p.strip_length);
    if (s.clamp > capacity.force()) {
        const double closure = free_closure(p, s, angle);
        flow(p, s, closure, capacity, dt);
        const double fallen = load.stiffness * (free_closure(p, s, angle) - closure);
        load = s.condition == Condition::broken ? SeatSpring::Load{}
                                                : p.seat.at(free_closure(p, s, angle), load.force + fallen);
        s.clamp = load.force;
        s.stiffness = load.stiffness;
        capacity.bolt = p.bolt.at(s.plastic);
    }
    // One use of the faces: the reference load taken up once by turning the nut, in as many pulls as it
    // takes.
    if (turned > 0.0) s.uses += std::max(0.0, s.clamp - clamp_before) / p.reference_load;
    s.stage = stage_of(p, s, capacity.ratio, capacity.bolt);
}

}  // namespace bolt::joint
