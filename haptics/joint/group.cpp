#include "haptics/joint/group.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <optional>
#include <utility>

namespace bolt::joint {

FlangePlate FlangePlate::make(double thickness, double E, double poisson, double interface_stiffness) {
    return {E * thickness * square(thickness) / (12.0 * (1.0 - square(poisson))), interface_stiffness};
}

double FlangePlate::length() const { return std::sqrt(std::sqrt(rigidity / foundation)); }

double FlangePlate::deflection_per_force(double r) const {
    const double l = length();
    return -square(l) / (2.0 * pi * rigidity) * kelvin_kei(r / l);
}

double kelvin_kei(double x) {
    if (x < 1e-9) return -0.25 * pi;
    // K0(z) = ∫₀^∞ exp(−z cosh t) dt. The integrand is even and analytic: the trapezoidal rule converges
    // exponentially.
    const std::complex<double> z = std::polar(x, 0.25 * pi);
    constexpr double step = 1.0 / 64.0;
    double sum = 0.5 * std::exp(-z).imag();
    for (double t = step;; t += step) {
        const std::complex<double> term = std::exp(-z * std::cosh(t));
        sum += term.imag();
        if (z.real() * std::cosh(t) > 40.0) break;
    }
    return sum * step;
}

InteractionMatrix interaction_matrix(const FlangePlate& plate, std::span<const Vec3> seats) {
    const double cutoff = 10.0 * plate.length();
    InteractionMatrix m;
    m.own_compliance = plate.deflection_per_force(0.0);
    m.row_begin.push_back(0);
    // Sorted by x, so that the cost for many joints is n log n instead of n².
    std::vector<std::uint32_t> by_x(seats.size());
    std::iota(by_x.begin(), by_x.end(), 0U);
    std::sort(by_x.begin(), by_x.end(), [&](auto a, auto b) { return seats[a].x < seats[b].x; });
    for (std::uint32_t i = 0; i < seats.size(); ++i) {
        const auto from = std::lower_bound(by_x.begin(), by_x.end(), seats[i].x - cutoff,
                                           [&](auto j, double x) { return seats[j].x < x; });
        const std::size_t row = m.column.size();
        for (auto j = from; j != by_x.end() && seats[*j].x <= seats[i].x + cutoff; ++j)
            if (*j != i && glm::distance(seats[i], seats[*j]) <= cutoff) m.column.push_back(*j);
        std::sort(m.column.begin() + static_cast<std::ptrdiff_t>(row), m.column.end());
        for (std::size_t k = row; k < m.column.size(); ++k)
            m.value.push_back(plate.deflection_per_force(glm::distance(seats[i], seats[m.column[k]])));
        m.row_begin.push_back(static_cast<std::uint32_t>(m.column.size()));
    }
    return m;
}

namespace {

double neighbour_closure(const InteractionMatrix& c, std::span<const JointState> joints, std::size_t i) {
    double closure = 0.0;
    for (std::uint32_t k = c.row_begin[i]; k < c.row_begin[i + 1]; ++k)
        closure += c.value[k] * joints[c.column[k]].mechanistic.clamp;
    return closure;
}

void copy_outputs(JointState& joint) {
    joint.clamp = joint.mechanistic.clamp;
    joint.breakaway = joint.mechanistic.breakaway;

    joint.stage = joint.mechanistic.stage;
    joint.condition = joint.mechanistic.condition;
}

void update_clamps(const GroupParameters& group, std::span<JointState> joints, int moved, const NutTurn& turn,
                   double dt) {
    TimeStep step(dt);
    for (std::size_t i = 0; i < joints.size(); ++i) {
        MechanisticState& s = joints[i].mechanistic;
        if (!group.interaction.row_begin.empty())
            s.neighbour_closure = neighbour_closure(group.interaction, joints, i);
        const bool turned = static_cast<int>(i) == moved;
        advance(group.joints[i], s, turned ? turn : NutTurn{s.angle, s.friction_share}, step);
        copy_outputs(joints[i]);
    }
}

void update_published(const PublishedLaw& published, JointState& joint, double angle, double friction_share) {
    const auto& [law, boundaries] = published;
    const double degrees = to_degrees(angle);
    published_advance(law, boundaries, joint.published, degrees);
    const Direction direction = friction_share < 0.0 ? Direction::loosen : Direction::tighten;
    const PublishedResponse reading =
        evaluate_published(law, boundaries, joint.published, degrees, direction);
    joint.clamp = reading.clamp;
    joint.stage = reading.stage;
}

}  // namespace

GroupParameters make_group(std::span<const JointDesign> designs, const FlangePlate* flange,
                           std::uint64_t seed) {
    GroupParameters group;
    std::vector<Vec3> seats;
    for (const JointDesign& design : designs) seats.push_back(design.seat);
    if (flange != nullptr && designs.size() > 1) group.interaction = interaction_matrix(*flange, seats);
    for (std::size_t i = 0; i < designs.size(); ++i) {
        Random random(seed, i);
        group.joints.push_back(derive(designs[i], random, group.interaction.own_compliance));
    }
    return group;
}

GroupParameters make_published_group(const std::vector<PublishedParameters>& joints) {
    GroupParameters group;
    group.law = Law::published;
    for (const PublishedParameters& joint : joints)
        group.published.push_back({joint, published_boundaries(joint)});
    return group;
}

std::vector<JointState> initial_state(const GroupParameters& group, std::size_t joints) {
    std::vector<JointState> states(joints);
    if (group.law == Law::mechanistic) update_clamps(group, states, -1, {}, 0.0);
    return states;
}

Resistance resistance(const GroupParameters& group, std::size_t joint, const JointState& state) {
    if (group.law == Law::mechanistic) return resistance(group.joints[joint], state.mechanistic);
    const auto& [law, boundaries] = group.published[joint];
    const double degrees = to_degrees(state.nut.angle);
    const auto on = evaluate_published(law, boundaries, state.published, degrees, Direction::tighten);
    const auto off = evaluate_published(law, boundaries, state.published, degrees, Direction::loosen);
    // The paper gives the torques of the stages different signs; the hand feels their magnitude, against the
    // motion.
    Resistance r;
    r.tighten = std::abs(on.torque);
    r.loosen = -std::abs(off.torque);
    if (on.stage == Stage::linearity) r.tighten_slope = to_degrees(published_linear_slope(law));
    if (on.stage == Stage::linearity || on.stage == Stage::yield)
        r.loosen_slope =
            -to_degrees(published_lever(law, Direction::loosen) / published_degrees_per_newton(law));
    return r;
}

namespace {

// The resistance of nut and bolt if they turn together; none if the held part cannot turn.
std::optional<Resistance> resistance_together(const GroupParameters& group, std::size_t joint,
                                              const JointState& state, double held_part_torque) {
    if (group.law != Law::mechanistic || !group.joints[joint].held_part_can_turn ||
        !std::isfinite(held_part_torque))
        return std::nullopt;
    return resistance_together(group.joints[joint], state.mechanistic, held_part_torque);
}

// The thread does not slide while nut and bolt turn together, so its friction only balances the torque.
double held_friction_share(const Resistance& on_thread, double torque) {
    const double lead = on_thread.lead_torque;
    const double friction = torque >= lead ? on_thread.tighten - lead : lead - on_thread.loosen;
    return friction > 0.0 ? std::clamp((torque - lead) / friction, -1.0, 1.0) : 0.0;
}

// A step of the driven part whose held part can turn: in each direction, the motion that needs less torque.
NutStep step_weaker(const Resistance& on_thread, const Resistance& together, double inertia,
                    JointState& joint, const NutDrive& drive, double dt) {
    const bool tightens_together = together.tighten < on_thread.tighten;
    const bool loosens_together = together.loosen > on_thread.loosen;
    Resistance weaker = on_thread;
    if (tightens_together) {
        weaker.tighten = together.tighten;
        weaker.tighten_slope = 0.0;
    }
    if (loosens_together) {
        weaker.loosen = together.loosen;
        weaker.loosen_slope = 0.0;
    }
    NutStep step = step_nut(weaker, inertia, joint.nut, drive, dt);
    if (step.nut.speed > 0.0 ? tightens_together : step.nut.speed < 0.0 && loosens_together) {
        joint.common_turn += step.nut.angle - joint.nut.angle;
        step.nut.angle = joint.nut.angle;
        step.friction_share = held_friction_share(on_thread, step.torque);
    }
    return step;
}

// One step of the driven part, on the thread or together with the held part. `drive`: relative to the bolt.
NutStep step_driven(const GroupParameters& group, std::size_t index, JointState& joint, const NutDrive& drive,
                    double dt) {
    const double inertia = drive_inertia(std::max(drive.stiffness, 1.0), dt);
    const Resistance on_thread = resistance(group, index, joint);
    const auto together = resistance_together(group, index, joint, drive.held_part_torque);
    NutStep step = together ? step_weaker(on_thread, *together, inertia, joint, drive, dt)
                            : step_nut(on_thread, inertia, joint.nut, drive, dt);
    if (step.nut.angle < 0.0) {  // end of the thread: the nut stops and the drive winds up
        step.nut = {};
        step.torque = wound_torque(drive, 0.0);
    }
    return step;
}

NutDrive relative_to_bolt(NutDrive drive, double common_turn) {
    drive.angle -= common_turn;
    return drive;
}

}  // namespace

ClickStep step_group(const GroupParameters& group, std::span<JointState> joints, int driven,
                     const NutDrive& drive, double dt) {
    ClickStep click;
    int moved = -1;
    NutTurn turn;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        joints[i].torque = 0.0;
        if (static_cast<int>(i) != driven || !drive.engaged)
            joints[i].nut.speed = 0.0;  // friction stops a free nut at once
    }
    if (driven >= 0 && static_cast<std::size_t>(driven) < joints.size()) {
        const auto i = static_cast<std::size_t>(driven);
        const double common_turn = joints[i].common_turn;
        const NutStep step = common_turn == 0.0
                                 ? step_driven(group, i, joints[i], drive, dt)
                                 : step_driven(group, i, joints[i], relative_to_bolt(drive, common_turn), dt);
        click = step.click;
        joints[i].nut = step.nut;
        joints[i].torque = step.torque;
        moved = driven;
        turn = {step.nut.angle, step.friction_share, joints[i].common_turn - common_turn};
    }
    if (group.law == Law::mechanistic)
        update_clamps(group, joints, moved, turn, dt);
    else if (moved >= 0)
        update_published(group.published[static_cast<std::size_t>(moved)],
                         joints[static_cast<std::size_t>(moved)], turn.angle, turn.friction_share);
    return click;
}

void turn_nut(const GroupParameters& group, std::span<JointState> joints, std::size_t joint, double angle,
              double friction_share, double dt) {
    JointState& j = joints[joint];
    j.nut = {angle, (angle - j.nut.angle) / dt};
    if (group.law == Law::mechanistic)
        update_clamps(group, joints, static_cast<int>(joint), {angle, friction_share}, dt);
    else
        update_published(group.published[joint], j, angle, friction_share);
    const Resistance r = resistance(group, joint, j);
    j.torque = friction_share >= 0.0 ? r.tighten : r.loosen;
}

namespace {

constexpr std::size_t max_samples = 2'000'000;

double signed_torque(const GroupParameters& group, const JointState& joint, Direction direction) {
    if (group.law == Law::mechanistic) return joint.torque;
    return evaluate_published(group.published[0].parameters, joint.published, to_degrees(joint.nut.angle),
                              direction)
        .torque;
}

bool has_failed(const JointState& joint) { return joint.condition != JointCondition::intact; }

// Tightens until the torque is reached or the joint fails, then rests for 10 s.
void tighten_to(const GroupParameters& group, std::vector<JointState>& joints, double torque,
                const CurveOptions& o) {
    for (std::size_t i = 0; i < max_samples && joints[0].torque < torque && !has_failed(joints[0]); ++i)
        turn_nut(group, joints, 0, joints[0].nut.angle + o.speed * o.dt, 1.0, o.dt);
    for (int i = 0; i < 10'000; ++i) step_group(group, joints, -1, NutDrive{}, 0.001);
}

}  // namespace

std::vector<CurveSample> torque_angle_curve(const GroupParameters& group, const CurveOptions& o) {
    std::vector<CurveSample> samples;
    std::vector<JointState> joints = initial_state(group, 1);
    JointState& joint = joints[0];
    const bool on = o.direction == Direction::tighten;
    if (!on) tighten_to(group, joints, o.torque, o);

    const double start = joint.nut.angle;
    const double step = (on ? 1.0 : -1.0) * o.speed * o.dt;
    double yield_begin = -1.0, free_begin = -1.0;
    for (std::size_t i = 0; i < max_samples; ++i) {
        turn_nut(group, joints, 0, start + step * static_cast<double>(i), on ? 1.0 : -1.0, o.dt);
        const double turned = std::abs(joint.nut.angle - start);
        samples.push_back({turned, joint.stage, signed_torque(group, joint, o.direction), joint.clamp});
        if (on) {
            if (joint.stage == Stage::yield && yield_begin < 0.0) yield_begin = turned;
            if (has_failed(joint) ||
                (yield_begin >= 0.0 && turned >= yield_begin + o.past_yield - 0.5 * std::abs(step)))
                break;
        } else {
            if (joint.stage != Stage::navigation)
                free_begin = -1.0;
            else if (free_begin < 0.0)
                free_begin = turned;
            if (free_begin >= 0.0 && turned >= free_begin + 0.5 * pi) break;
            if (joint.nut.angle <= 0.0) break;
        }
    }
    return samples;
}

}  // namespace bolt::joint
