#include "haptics/servo/touch.hpp"

#include <cmath>

namespace bolt::servo {

namespace {

constexpr std::int32_t first_nut = 1000;  // id of the first joint's nut

// A jaw that was on a nut and let go of it still surrounds it: the nut is an obstacle again when the jaw is
// clear of it.
bool clear_of(const NutPlace& nut, double nut_angle, const Pose& wrench) {
    const Vec3 from = wrench.position - (nut_pose(nut, nut_angle).position + 0.5 * nut.height * nut.axis);
    const double axial = glm::dot(from, nut.axis);
    return std::abs(axial) > 1.5 * nut.height ||
           glm::length(from - axial * nut.axis) > 1.5 * nut.across_flats;
}

}  // namespace

Pose nut_pose(const NutPlace& nut, double nut_angle) {
    const double gap = std::max(0.0, nut.start_gap - nut.lead * nut_angle);
    const Quat seat = glm::normalize(glm::quat_cast(glm::dmat3(nut.e1, nut.e2, nut.axis)));
    // Tightening turns about -axis.
    return {nut.seat + gap * nut.axis, seat * glm::angleAxis(-nut_angle, Vec3(0, 0, 1))};
}

void set_coupling(const Setup& setup, Touch& touch) {
    force::CouplingRange range;
    range.force = setup.limits.force;
    range.torque = setup.limits.torque;
    range.stiffness = setup.limits.stiffness;
    range.torsion = setup.limits.torsion;
    range.dt = setup.dt;
    touch.parameters.coupling = force::make_coupling(range);
}

Result<Touch> make_touch(const Setup& setup, const TouchDescription& d) {
    Touch touch;
    std::vector<contact::Obstacle> obstacles;
    for (const contact::ContactMesh& mesh : d.still)
        obstacles.push_back({static_cast<std::int32_t>(obstacles.size()), &mesh, {}, false});
    for (std::size_t i = 0; i < d.nuts.size() && i < setup.nuts.size(); ++i)
        if (!d.nuts[i].triangles.empty())
            obstacles.push_back(
                {first_nut + static_cast<std::int32_t>(i), &d.nuts[i], nut_pose(setup.nuts[i], 0.0), true});
    Result<contact::World> world = contact::make_world(obstacles);
    if (!world) return fail(world.error());
    touch.world = std::move(*world);
    Result<contact::ToolShape> wrench = contact::make_tool(d.wrench);
    if (!wrench) return fail(wrench.error());
    touch.wrench = std::move(*wrench);
    for (std::size_t i = 0; i < setup.nuts.size(); ++i)
        touch.nuts.push_back(contact::find_body(touch.world, first_nut + static_cast<std::int32_t>(i)));
    touch.proximity = contact::make_proximity(touch.world, touch.wrench);

    set_coupling(setup, touch);
    touch.parameters.radius = touch.wrench.reach();
    touch.parameters.friction = d.friction;
    return touch;
}

force::Wanted step_touch(const Setup& setup, Touch& touch, std::span<const joint::JointState> joints,
                         const Pose& hand, bool held, int on_nut) {
    for (std::size_t i = 0; i < touch.nuts.size(); ++i) {
        if (!touch.nuts[i]) continue;
        contact::Body& body = touch.world.bodies[*touch.nuts[i]];
        const double angle = joints[i].nut.angle;
        body.pose = nut_pose(setup.nuts[i], angle);
        if (static_cast<int>(i) == on_nut)
            body.on = false;
        else if (!body.on)
            body.on = !held || clear_of(setup.nuts[i], angle, touch.god_object.tool);
    }
    if (!held || !touch.in_hand) {
        touch.god_object = contact::start_god_object(hand);
        touch.last = {};
        touch.in_hand = held;
        if (!held) return {};
    }
    const auto find = [&](const Pose& pose, double band, std::span<contact::Contact> out) {
        return contact::find_contacts(touch.world, touch.wrench, pose, band, touch.proximity, out);
    };
    touch.last = contact::step_god_object(touch.parameters, touch.god_object, hand, find, setup.dt);
    force::Wanted wanted;
    wanted.command = touch.god_object.felt;
    wanted.stored = force::stored_energy(touch.parameters.coupling, touch.god_object.offset);
    return wanted;
}

bool hidden(const Touch& touch, const Vec3& from, const Vec3& to, int joint) {
    const auto i = static_cast<std::size_t>(joint);
    const bool own = joint >= 0 && i < touch.nuts.size();
    return contact::occluded(touch.world, from, to, own ? touch.nuts[i] : std::nullopt);
}

}  // namespace bolt::servo
