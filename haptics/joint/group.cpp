#include "haptics/joint/group.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::joint {

namespace {

double neighbour_closure(const CouplingMatrix& c, std::span<const JointState> joints, std::size_t i) {
    double closure = 0.0;
    for (std::uint32_t k = c.row_begin[i]; k < c.row_begin[i + 1]; ++k)
        closure += c.value[k] * joints[c.column[k]].mechanistic.clamp;
    return closure;
}

void publish(JointState& joint) {
    joint.clamp = joint.mechanistic.clamp;
    joint.breakaway = joint.mechanistic.dwell;

    joint.stage = joint.mechanistic.stage;
    joint.condition = joint.mechanistic.condition;
}

void settle(const GroupParameters& group, std::span<JointState> joints, int moved, double angle, double share,
            double dt) {
    for (std::size_t i = 0; i < joints.size(); ++i) {
        MechanisticState& s = joints[i].mechanistic;
        if (!group.coupling.row_begin.empty()) s.neighbours = neighbour_closure(group.coupling, joints, i);
        const bool turned = static_cast<int>(i) == moved;
        advance(group.joints[i], s, turned ? angle : s.angle, turned ? share : s.share, dt);
        publish(joints[i]);
    }
}

void settle_published(const GroupParameters& group, JointState& joint, double angle, double share) {
    const double degrees = to_degrees(angle);
    published_advance(group.published, joint.published, degrees);
    const Direction direction = share < 0.0 ? Direction::loosen : Direction::tighten;
    const PublishedReading reading = published_read(group.published, joint.published, degrees, direction);
    joint.clamp = reading.clamp;
    joint.stage = reading.stage;
}

}  // namespace

GroupParameters make_group(std::span<const JointDesign> designs, const FlangePlate* flange,
                           std::uint64_t seed) {
    GroupParameters group;
    std::vector<Vec3> seats;
    for (const JointDesign& design : designs) seats.push_back(design.seat);
    if (flange != nullptr && designs.size() > 1) group.coupling = couple(*flange, seats);
    for (std::size_t i = 0; i < designs.size(); ++i) {
        Random random(seed, i);
        group.joints.push_back(derive(designs[i], random, group.coupling.own));
    }
    return group;
}

GroupParameters make_published_group(const PublishedParameters& parameters) {
    GroupParameters group;
    group.law = Law::published;
    group.published = parameters;
    return group;
}

std::vector<JointState> initial_state(const GroupParameters& group, std::size_t joints) {
    std::vector<JointState> states(joints);
    if (group.law == Law::mechanistic) settle(group, states, -1, 0.0, 0.0, 0.0);
    return states;
}

Resistance resistance(const GroupParameters& group, std::size_t joint, const JointState& state) {
    if (group.law == Law::mechanistic) return resistance(group.joints[joint], state.mechanistic);
    const double degrees = to_degrees(state.nut.angle);
    const auto on = published_read(group.published, state.published, degrees, Direction::tighten);
    const auto off = published_read(group.published, state.published, degrees, Direction::loosen);
    // The print gives the torques of the stages different signs; what is felt is their size, against the
    // motion.
    Resistance r;
    r.tighten = std::abs(on.torque);
    r.loosen = -std::abs(off.torque);
    if (on.stage == Stage::yield)
        r.loosen_slope = -to_degrees(published_lever(group.published, Direction::loosen) /
                                     published_degrees_per_newton(group.published));
    if (on.stage == Stage::linearity) {
        r.tighten_slope = to_degrees(published_linear_slope(group.published));
        r.loosen_slope = -to_degrees(published_lever(group.published, Direction::loosen) /
                                     published_degrees_per_newton(group.published));
    }
    return r;
}

ClickStep step_group(const GroupParameters& group, std::span<JointState> joints, int driven,
                     const Handle& handle, double dt) {
    ClickStep click;
    int moved = -1;
    double angle = 0.0, share = 0.0;
    for (std::size_t i = 0; i < joints.size(); ++i) {
        joints[i].torque = 0.0;
        if (static_cast<int>(i) != driven || !handle.engaged)
            joints[i].nut.speed = 0.0;  // friction stops a free nut at once
    }
    if (driven >= 0 && static_cast<std::size_t>(driven) < joints.size()) {
        const auto i = static_cast<std::size_t>(driven);
        const double inertia = coupling_inertia(std::max(handle.stiffness, 1.0), dt);
        NutStep step = step_nut(resistance(group, i, joints[i]), inertia, joints[i].nut, handle, dt);
        click = step.click;
        if (step.nut.angle < 0.0) {  // the end of the bolt: it stops there and the hand winds up
            step.nut = {};
            step.torque = wound_torque(handle, 0.0);
        }
        joints[i].nut = step.nut;
        joints[i].torque = step.torque;
        moved = driven;
        angle = step.nut.angle;
        share = step.share;
    }
    if (group.law == Law::mechanistic)
        settle(group, joints, moved, angle, share, dt);
    else if (moved >= 0)
        settle_published(group, joints[static_cast<std::size_t>(moved)], angle, share);
    return click;
}

void turn_nut(const GroupParameters& group, std::span<JointState> joints, std::size_t joint, double angle,
              double share, double dt) {
    JointState& j = joints[joint];
    j.nut = {angle, (angle - j.nut.angle) / dt};
    if (group.law == Law::mechanistic)
        settle(group, joints, static_cast<int>(joint), angle, share, dt);
    else
        settle_published(group, j, angle, share);
    const Resistance r = resistance(group, joint, j);
    j.torque = share >= 0.0 ? r.tighten : r.loosen;
}

}  // namespace bolt::joint
