#include "haptics/joint/nut.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::joint {

namespace {

// kg·m², of the nut without a wrench.
constexpr double nut_inertia = 1e-5;

// Torque on the nut as a function of the speed ω after the step: at_rest − dt · stiffness · ω.
struct SpringTorque {
    double at_rest = 0.0;
    double stiffness = 0.0;
};

double next_speed(const Resistance& r, double inertia, NutMotion nut, const SpringTorque& spring, double dt) {
    const double driving_torque = inertia * nut.speed / dt + spring.at_rest;
    const double impedance = inertia / dt + dt * spring.stiffness;
    const double min_impedance = 0.1 * inertia / dt;  // least divisor, for a slope below step_nut()'s bound
    if (driving_torque > r.tighten)
        return (driving_torque - r.tighten) / std::max(impedance + dt * r.tighten_slope, min_impedance);
    if (driving_torque < r.loosen)
        return (driving_torque - r.loosen) / std::max(impedance + dt * r.loosen_slope, min_impedance);
    return 0.0;
}

double friction_share_of(const Resistance& r, double torque, double speed) {
    if (speed != 0.0) return speed > 0.0 ? 1.0 : -1.0;
    const double friction = torque >= r.lead_torque ? r.tighten - r.lead_torque : r.lead_torque - r.loosen;
    return friction > 0.0 ? std::clamp((torque - r.lead_torque) / friction, -1.0, 1.0) : 0.0;
}

NutStep step_rigid(const Resistance& resistance, double inertia, NutMotion nut, const NutDrive& drive,
                   double dt) {
    // A nut that would run down by its own weight is held by the fingers that started it: it rests at zero
    // torque.
    Resistance r = resistance;
    r.tighten = std::max(r.tighten, 0.0);
    r.loosen = std::min(r.loosen, 0.0);

    NutStep step;
    const double gap = drive.engaged ? drive.angle - nut.angle : 0.0;
    double wound = gap - std::clamp(gap, -drive.half_play, drive.half_play);
    SpringTorque spring{drive.stiffness * wound, wound == 0.0 ? 0.0 : drive.stiffness};
    const double moving = wound == 0.0 ? std::min(inertia, nut_inertia) : inertia;  // kg·m²
    double speed = next_speed(r, moving, nut, spring, dt);
    if (wound == 0.0 && drive.engaged && std::abs(gap - dt * speed) > drive.half_play) {
        // The nut would leave the play within the step, so the edge that it meets acts in this step already.
        // Otherwise the nut would return from each edge faster than it arrived.
        const double edge = std::copysign(drive.half_play, gap - dt * speed);
        wound = gap - edge;
        spring = {drive.stiffness * wound, drive.stiffness};
        speed = next_speed(r, moving, nut, spring, dt);
        wound = std::copysign(1.0, edge);  // the side that pushes, for the test below
    }
    step.torque = spring.at_rest - dt * spring.stiffness * speed;

    const double limit = drive.torque_limit;
    if (limit > 0.0 && std::abs(step.torque) > limit) {
        spring = {std::copysign(limit, wound), 0.0};
        speed = next_speed(r, moving, nut, spring, dt);
        step.torque = spring.at_rest;
        step.slipped = true;
    } else if (step.torque * wound < 0.0) {  // a jaw pushes; it does not pull
        spring = {};
        speed = next_speed(r, moving, nut, spring, dt);
        step.torque = 0.0;
        // A nut that would cross the whole play within the step stops at the other edge.
        const double after = gap - dt * speed;
        if (std::abs(after) > drive.half_play && after * gap < 0.0)
            speed = (gap - std::copysign(drive.half_play, after)) / dt;
    }
    step.nut = {nut.angle + dt * speed, speed};
    step.friction_share = friction_share_of(r, step.torque, speed);
    return step;
}

// A mechanism that swings against `resisting_torque` (N·m) is equivalent, over one implicit step, to a softer
// spring that is wound further. This follows from c (swung' − swung)/dt = T' − resisting_torque, inserted
// into T' = K (hand − nut' − swung' ∓ play); primed values are those after the step.
NutDrive swinging_drive(const NutDrive& drive, double resisting_torque, double dt) {
    const double share = dt / drive.click.settling_time;
    NutDrive soft = drive;
    soft.angle += share * resisting_torque / drive.stiffness - drive.swung;
    soft.stiffness = drive.stiffness / (1.0 + share);
    return soft;
}

// Selects the consistent one of three cases: standing, swinging on, swinging back. Only one is consistent,
// because a mechanism that has swung resists in proportion to its speed, and one that has not swung holds up
// to its set torque.
NutStep step_clicking(const Resistance& r, double inertia, NutMotion nut, const NutDrive& drive, double dt) {
    const Click& click = drive.click;
    const double swing_torque = click.swing_torque_share * click.set_torque,
                 rearm_torque = click.rearm_torque_share * click.set_torque;
    const auto standing_at = [&](double swung) {
        NutDrive stiff = drive;
        stiff.angle -= swung;
        NutStep step = step_rigid(r, inertia, nut, stiff, dt);
        step.click.swung = swung;
        return step;
    };
    const NutStep standing = standing_at(drive.swung);
    const bool armed = drive.swung <= 0.0;
    const bool swings_on =
        drive.swung < click.swing && standing.torque > (armed ? click.set_torque : swing_torque);
    const bool swings_back = !armed && standing.torque < rearm_torque;
    if (!swings_on && !swings_back) return standing;
    const double resisting_torque = swings_on ? swing_torque : rearm_torque;
    NutStep step = step_rigid(r, inertia, nut, swinging_drive(drive, resisting_torque, dt), dt);
    const double swung =
        drive.swung + (step.torque - resisting_torque) * dt / (drive.stiffness * click.settling_time);
    if (swung >= click.swing)
        step = standing_at(click.swing);
    else if (swung <= 0.0)
        step = standing_at(0.0);
    else
        step.click.swung = swung;
    step.click.clicked = armed && step.click.swung > 0.0;
    return step;
}

}  // namespace

double adaptor_ratio(double lever, double adaptor, double angle) {
    return (lever + adaptor * std::cos(angle)) / lever;
}

double wound_torque(const NutDrive& drive, double nut_angle) {
    if (!drive.engaged) return 0.0;
    const double gap = drive.angle - drive.swung - nut_angle;
    const double torque = drive.stiffness * (gap - std::clamp(gap, -drive.half_play, drive.half_play));
    return drive.torque_limit > 0.0 ? std::clamp(torque, -drive.torque_limit, drive.torque_limit) : torque;
}

NutStep step_nut(const Resistance& resistance, double inertia, NutMotion nut, const NutDrive& drive,
                 double dt) {
    if (drive.engaged && drive.click.trips()) return step_clicking(resistance, inertia, nut, drive, dt);
    return step_rigid(resistance, inertia, nut, drive, dt);
}

namespace {

constexpr double pascals_per_vickers = 9.80665e6;
constexpr double wedge_angle = 2.0 * pi / 3.0;  // rad, between two flats

struct Hardness {
    std::string_view bolts;  // the bolt class, or its beginning
    double small, large;     // HV; `small` up to M16, `large` above
};

// The first matching row applies.
constexpr Hardness nut_hardnesses[] = {
    {"12.", 295, 272}, {"10.", 272, 272}, {"9.", 188, 188}, {"8.", 200, 233},
    {"6.", 150, 170},  {"5.", 130, 146},  {"4.", 130, 146},
};

constexpr Hardness bolt_hardnesses[] = {
    {"4.6", 120, 120}, {"4.8", 130, 130}, {"5.6", 155, 155},  {"5.8", 160, 160},
    {"6.8", 190, 190}, {"8.8", 250, 255}, {"10.9", 320, 320}, {"12.9", 385, 385},
};

}  // namespace

double nut_hardness(const PropertyClass& bolt_class, double d) {
    for (const Hardness& row : nut_hardnesses)
        if (bolt_class.name.starts_with(row.bolts))
            return pascals_per_vickers * (d < 16.5e-3 ? row.small : row.large);
    return 3.0 * bolt_class.R_m;
}

double bolt_hardness(const PropertyClass& bolt_class, double d) {
    for (const Hardness& row : bolt_hardnesses)
        if (bolt_class.name == row.bolts) return pascals_per_vickers * (d < 16.5e-3 ? row.small : row.large);
    return 3.0 * bolt_class.R_m;
}

double turned_part_hardness(const JointDesign& design) {
    return design.turned == TurnedPart::head ? bolt_hardness(design.bolt_class, design.thread.size.d)
                                             : nut_hardness(design.bolt_class, design.thread.size.d);
}

double corner_pressure(double hardness) {
    const double flow = hardness / 3.0;
    return 2.0 / std::sqrt(3.0) * flow * (1.0 + wedge_angle - 0.5 * pi);
}

double socket_pressure(double hardness) {
    const double flow = hardness / 3.0;
    return 2.0 / std::sqrt(3.0) * flow * (1.0 + 0.5 * pi);
}

namespace {

// m of `height` over which a tilted head bears.
double bearing_height(double height, double tilt, double clearance) {
    const double slope = std::tan(std::abs(tilt));
    return slope * height > clearance ? clearance / slope : height;
}

}  // namespace

double ring_torque(double pressure, const RingGrip& g) {
    const double height = bearing_height(g.height, g.tilt, g.clearance);
    const double half = 0.5 * g.across_flats;
    const double x = std::max(0.0, half / std::sqrt(3.0) - g.rounded);
    const double x0 = g.points == 12 ? std::min(x, half * std::tan(pi / 12.0)) : 0.0;
    return 3.0 * pressure * std::max(0.0, height) * (x * x - x0 * x0);
}

double corner_torque(double pressure, const CornerGrip& g) {
    const double height = bearing_height(g.height, g.tilt, g.clearance);
    const double spread = 0.5 * (g.toward_throat + g.toward_mouth) - g.rounded;
    return pressure * std::max(0.0, height) * square(std::max(0.0, spread));
}

double rounded_half_play(double opening, double across_flats, double rounded) {
    // cos ψ s/2 + sin ψ x = w/2 with x = s/√12 - rounded.
    const double half = 0.5 * across_flats;
    const double x = std::max(0.0, half / std::sqrt(3.0) - rounded), reach = std::hypot(half, x);
    const double corner_angle = std::atan2(x, half), c = 0.5 * opening / reach;
    return c >= 1.0 ? pi / 6.0 : std::max(0.0, corner_angle - std::acos(c));
}

}  // namespace bolt::joint
