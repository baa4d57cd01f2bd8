#include "haptics/servo/tool_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "haptics/collision/narrow_phase.hpp"
#include "haptics/joint/nut.hpp"
#include "haptics/servo/engagement.hpp"

namespace bolt::servo {

namespace {

// Merging contacts assumes that the tool moves less than merge_stride between two queries.
static_assert(proxy::GodObjectParameters{}.stride <= collision::merge_stride);

constexpr double contact_distance = 1.5;  // skins; nearer contacts count as touching

// m between head and hexagon. The clearance of a jaw is a tenth of a millimetre to each side; the usual skin
// would fill it.
constexpr double grip_skin = 2e-6;
constexpr double both_skins = 2.5;  // of grip_skin: one on each flank, and a margin

// Shares of the width across the head's flats. A nut whose centre is within these limits can touch only the
// head of the tool.
constexpr double max_offset_across = 0.15, max_offset_to_throat = 0.25;
constexpr double nearly_level = 0.99;  // cos 8°

// The tool's pose, for tests of many nuts in one tick. Axes of the jaw: x along the slot towards its throat,
// y across, z normal.
struct HeadPose {
    Pose to_tool;  // from the assembly's frame to the tool's
    Quat to_jaw;   // from the tool's axes to the jaw's
    Vec3 normal;   // in the assembly's frame
};

HeadPose head_pose(const Setup& setup, const Pose& wrench) {
    return {inverse(wrench), glm::angleAxis(-setup.wrench.head_angle, Vec3(0, 0, 1)),
            wrench.orientation * Vec3(0, 0, 1)};
}

// Returns true if only the tool's head can touch the nut in this tick and the next ones.
bool only_head_in_reach(const Setup& setup, const NutGeometry& nut, const Pose& nut_frame,
                        const HeadPose& head) {
    const double opening = collision::width_across_flats(setup.wrench.head);
    const Vec3 p = head.to_jaw * (head.to_tool * (nut_frame.position + 0.5 * nut.height * nut.axis));
    const double level = glm::dot(head.normal, nut.axis);
    if (!std::holds_alternative<collision::Jaw>(setup.wrench.head))
        return std::hypot(p.x, p.y) < max_offset_across * opening && level > nearly_level;
    return std::abs(p.y) < max_offset_across * opening && p.x < max_offset_to_throat * opening &&
           std::abs(level) > nearly_level;
}

collision::GripQuery query_of(const Setup& setup, const ToolContact& contact, std::size_t joint,
                              double band) {
    return {setup.wrench.head,
            contact.shapes[joint],
            {contact.head, contact.shape_solids[joint]},
            band,
            collision::ObstacleId::nut(joint)};
}

bool equal(const Pose& a, const Pose& b) {
    return a.position == b.position && a.orientation == b.orientation;
}

// Computes the pose of the nut at joint `i` if its angles have changed. Returns true if the pose is the same.
bool update_nut_pose(const Setup& setup, ToolContact& contact, std::size_t i,
                     const joint::JointState& joint) {
    const NutAngles angles{joint.nut.angle, joint.common_turn};
    if (angles == contact.nut_angles[i]) return true;
    const Pose nut_frame = nut_pose(setup.nuts[i], angles.nut_angle, angles.common_turn);
    const bool unchanged = equal(nut_frame, contact.nut_poses[i]);
    contact.nut_angles[i] = angles;
    contact.nut_poses[i] = nut_frame;
    return unchanged;
}

void update_nut_poses(const Setup& setup, ToolContact& contact, std::span<const joint::JointState> joints,
                      bool held) {
    const HeadPose head = head_pose(setup, contact.god_object.constrained_tool);
    for (std::size_t i = 0; i < contact.nut_poses.size(); ++i) {
        const bool unchanged = update_nut_pose(setup, contact, i, joints[i]);
        contact.cache.nuts_unchanged = contact.cache.nuts_unchanged && unchanged;
        if (!contact.nut_bodies[i]) continue;
        collision::Body& body = contact.world.bodies[*contact.nut_bodies[i]];
        body.pose = contact.nut_poses[i];
        const bool enabled = !held || contact.shape_solids[i].empty() ||
                             !only_head_in_reach(setup, setup.nuts[i], contact.nut_poses[i], head);
        contact.cache.meshes_unchanged =
            contact.cache.meshes_unchanged && enabled == body.enabled && (unchanged || !enabled);
        body.enabled = enabled;
    }
}

// Returns the pose that contact queries use for the nut in the tool's head. Once the head has turned by more
// than the play, less the room for a skin on each flank, the nut turns with it. Two flanks pressed at once
// would be contradictory constraints with unlimited friction.
Pose pose_in_tool(const Setup& setup, const NutGeometry& nut, const Pose& nut_frame, const Pose& wrench) {
    const double off =
        collision::head_fit(setup.wrench.head, shape_of(nut), inverse(nut_frame) * wrench).misalignment;
    const double play = half_play(setup.wrench, nut.across_flats, 0.0);
    const double lever = 0.5 * nut.across_flats * (std::cos(play) / std::sqrt(3.0) - std::sin(play));
    const double room = std::max(0.0, play - both_skins * grip_skin / lever);
    const double beyond = off - std::clamp(off, -room, room);
    return {nut_frame.position, nut_frame.orientation * glm::angleAxis(-beyond, Vec3(0, 0, 1))};
}

// Contacts of the tool's head with all nuts that it can turn, up to the size of `out`. If more exist, the
// result is marked as truncated.
collision::ContactQueryResult find_grip_contacts(const Setup& setup, const ToolContact& contact,
                                                 const Pose& pose, double band,
                                                 std::span<collision::Contact> out) {
    const double skin_reduction = contact.parameters.skin - grip_skin;
    collision::ContactQueryResult found{0, band, false};
    std::array<collision::Contact, collision::max_grip_contacts> contacts;
    for (std::size_t i = 0; i < contact.shapes.size(); ++i) {
        if (contact.shape_solids[i].empty()) continue;
        if (glm::distance(contact.nut_poses[i].position, pose.position) > contact.grip_reach[i] + band)
            continue;
        const NutGeometry& nut = setup.nuts[i];
        const bool at_head = static_cast<int>(i) == contact.joint_at_head;
        const Pose nut_frame =
            at_head ? pose_in_tool(setup, nut, contact.nut_poses[i], pose) : contact.nut_poses[i];
        const std::size_t count =
            collision::grip_contacts(query_of(setup, contact, i, band), pose, nut_frame, contacts);
        if (at_head)
            collision::remove_axial_moment(nut_frame.position, nut.axis, std::span(contacts).first(count));
        for (std::size_t k = 0; k < count; ++k) {
            collision::Contact& c = contacts[k];
            c.distance += skin_reduction;
            if (found.count < out.size()) {
                out[found.count++] = c;
            } else {
                found.truncated = true;
                found.complete_within = std::min(found.complete_within, c.distance);
            }
        }
    }
    return found;
}

// Contacts between meshes, without those of nuts that the closed form covers.
collision::ContactQueryResult find_mesh_contacts(ToolContact& contact, const Pose& pose, double band,
                                                 std::span<collision::Contact> out) {
    collision::ContactQueryResult found =
        collision::find_contacts(contact.world, contact.wrench, pose, band, contact.narrow_phase, out);
    collision::smooth_normals(contact.world, contact.wrench, pose, out.first(found.count));
    const auto is_covered = [&](const collision::Contact& c) {
        return c.obstacle.is_nut() && !contact.shape_solids[c.obstacle.index()].empty() &&
               collision::covered(contact.head, inverse(pose) * c.on_tool);
    };
    const auto end = out.begin() + static_cast<std::ptrdiff_t>(found.count);
    found.count = static_cast<std::size_t>(std::remove_if(out.begin(), end, is_covered) - out.begin());
    return found;
}

// A tick often starts at the pose where the last one ended. The cache then returns the contacts of all bodies
// that did not move; if only the held nut moved, only the contacts of the head are computed again.
collision::ContactQueryResult find_contacts_cached(const Setup& setup, ToolContact& contact, const Pose& pose,
                                                   double band, std::span<collision::Contact> out) {
    ContactCache& last = contact.cache;
    const bool same_query = last.band == band && equal(last.pose, pose);
    const auto kept = std::span(last.contacts).first(last.count);
    const bool nuts_unchanged = same_query && last.nuts_unchanged;
    // The head's contacts come first, so their number limits the space that is left for those of meshes.
    const std::size_t grip_contacts_before = last.nuts.count;
    if (nuts_unchanged)
        std::copy_n(kept.begin(), last.nuts.count, out.begin());
    else
        last.nuts = find_grip_contacts(setup, contact, pose, band, out);
    const auto rest = out.subspan(last.nuts.count);
    collision::ContactQueryResult found = last.meshes;
    found.query_cost = 0;
    if (same_query && last.meshes_unchanged && last.nuts.count == grip_contacts_before)
        std::copy_n(kept.begin() + static_cast<std::ptrdiff_t>(grip_contacts_before), found.count,
                    rest.begin());
    else
        found = last.meshes = find_mesh_contacts(contact, pose, band, rest);
    found.count += last.nuts.count;
    found.complete_within = std::min(found.complete_within, last.nuts.complete_within);
    found.truncated = found.truncated || last.nuts.truncated;

    std::copy_n(out.begin(), found.count, last.contacts.begin());
    last.count = found.count;
    last.pose = pose;
    last.band = band;
    last.nuts_unchanged = last.meshes_unchanged = true;
    return found;
}

// A head that no longer holds a nut is clear when it has no contact with the hexagon at its actual pose.
bool head_is_clear(const Setup& setup, const ToolContact& contact, std::size_t i) {
    std::array<collision::Contact, collision::max_grip_contacts> contacts;
    return collision::grip_contacts(query_of(setup, contact, i, 0.0), contact.god_object.constrained_tool,
                                    contact.nut_poses[i], contacts) == 0;
}

// Returns the obstacle of the nearest contact if it touches, none otherwise.
collision::ObstacleId touched_obstacle(std::span<const collision::Contact> contacts, double skin) {
    const auto nearest = std::min_element(contacts.begin(), contacts.end(), [](const auto& a, const auto& b) {
        return a.distance < b.distance;
    });
    return nearest != contacts.end() && nearest->distance < contact_distance * skin ? nearest->obstacle
                                                                                    : collision::ObstacleId();
}

}  // namespace

void set_coupling(const Setup& setup, ToolContact& contact) {
    proxy::CouplingRange range;
    range.max_force = setup.limits.force;
    range.max_torque = setup.limits.torque;
    range.stiffness = setup.limits.stiffness;
    // A device without torque has no limit of its own, but the god-object needs a spring to choose between
    // turning and moving the tool.
    const force::OutputLimits usual;
    range.torsion = setup.limits.torsion > 0.0 ? setup.limits.torsion
                                               : setup.limits.stiffness * usual.torsion / usual.stiffness;
    range.dt = setup.dt;
    contact.parameters.coupling = proxy::make_coupling(range);
}

namespace {

Result<ToolInContact> make_tool_in_contact(const collision::ToolHead& head,
                                           std::span<const collision::ContactMesh> meshes,
                                           const ToolContact& contact) {
    ToolInContact tool;
    Result<collision::ToolShape> shape = collision::make_tool(meshes);
    if (!shape) return fail(shape.error());
    tool.shape = std::move(*shape);
    for (const collision::TurnedShape& turned : contact.shapes) {
        tool.shape_solids.emplace_back();
        if (!collision::grips(head, turned)) continue;
        BOLT_TRY_ASSIGN(auto solids, collision::shape_solids(turned));
        tool.shape_solids.back() = std::move(solids);
    }
    BOLT_TRY_ASSIGN(auto solids, collision::head_solids(head));
    tool.head = std::move(solids);
    for (const auto& solids_of_shape : tool.shape_solids)
        tool.grip_reach.push_back(collision::grip_reach({tool.head, solids_of_shape}));
    tool.narrow_phase = collision::make_narrow_phase(contact.world, tool.shape);
    return tool;
}

// Exchanges the tool in use with one of `tools`.
void swap_in(ToolContact& contact, std::size_t index) {
    ToolInContact& tool = contact.tools[index];
    std::swap(contact.wrench, tool.shape);
    std::swap(contact.narrow_phase, tool.narrow_phase);
    std::swap(contact.head, tool.head);
    std::swap(contact.shape_solids, tool.shape_solids);
    std::swap(contact.grip_reach, tool.grip_reach);
    contact.parameters.radius = contact.wrench.origin_radius();
    contact.parameters.box = contact.wrench.solid.box;
}

}  // namespace

void use_tool(ToolContact& contact, std::size_t from, std::size_t to) {
    swap_in(contact, from);
    swap_in(contact, to);
    contact.cache.nuts_unchanged = contact.cache.meshes_unchanged = false;
    contact.joint_at_head = -1;
    contact.in_hand = false;
}

Result<ToolContact> make_tool_contact(const Setup& setup, const ToolContactDescription& d) {
    ToolContact contact;
    std::vector<collision::Obstacle> obstacles;
    for (const collision::ContactMesh& mesh : d.fixed)
        obstacles.push_back({collision::ObstacleId::fixed(obstacles.size()), &mesh, {}, false});
    for (std::size_t i = 0; i < d.nuts.size() && i < setup.nuts.size(); ++i)
        if (!d.nuts[i].triangles.empty())
            obstacles.push_back(
                {collision::ObstacleId::nut(i), &d.nuts[i], nut_pose(setup.nuts[i], 0.0), true});
    Result<collision::CollisionWorld> world = collision::make_world(obstacles);
    if (!world) return fail(world.error());
    contact.world = std::move(*world);
    for (std::size_t i = 0; i < setup.nuts.size(); ++i) {
        contact.nut_bodies.push_back(collision::find_body(contact.world, collision::ObstacleId::nut(i)));
        contact.shapes.push_back(shape_of(setup.nuts[i]));
        contact.nut_poses.push_back(nut_pose(setup.nuts[i], 0.0));
        contact.nut_angles.emplace_back();
    }
    for (std::size_t k = 0; k < d.tools.size(); ++k) {
        BOLT_TRY_ASSIGN(auto tool, make_tool_in_contact(setup.tools[k].wrench.head, d.tools[k], contact));
        contact.tools.push_back(std::move(tool));
    }
    swap_in(contact, setup.tool);

    set_coupling(setup, contact);
    contact.parameters.friction_coefficient = d.friction_coefficient;
    contact.parameters.allows_narrow_gaps = setup.allows_narrow_gaps;
    return contact;
}

force::ForceRequest step_tool_contact(const Setup& setup, ToolContact& contact,
                                      std::span<const joint::JointState> joints, const Pose& commanded_tool,
                                      bool held, int engaged_joint) {
    update_nut_poses(setup, contact, joints, held);
    const int joint_at_head_before = contact.joint_at_head;
    if (engaged_joint >= 0)
        contact.joint_at_head = engaged_joint;
    else if (contact.joint_at_head >= 0 &&
             (!held || head_is_clear(setup, contact, static_cast<std::size_t>(contact.joint_at_head))))
        contact.joint_at_head = -1;
    contact.cache.nuts_unchanged =
        contact.cache.nuts_unchanged && contact.joint_at_head == joint_at_head_before;
    if (!held || !contact.in_hand) {
        contact.god_object = proxy::start_god_object(commanded_tool);
        contact.last_step = {};
        contact.touched = {};
        contact.in_hand = held;
        if (!held) return {};
    }
    const auto finder = [&](const Pose& pose, double band, std::span<collision::Contact> out) {
        const collision::ContactQueryResult found = find_contacts_cached(setup, contact, pose, band, out);
        contact.touched = touched_obstacle(out.first(found.count), contact.parameters.skin);
        return found;
    };
    contact.last_step =
        proxy::step_god_object(contact.parameters, contact.god_object, commanded_tool, finder, setup.dt);
    force::ForceRequest request;
    request.command = contact.god_object.rendered;
    request.stored_energy = proxy::stored_energy(contact.parameters.coupling, contact.god_object.offset);
    return request;
}

std::vector<collision::SurfacePoint> turned_part_samples(const ToolContact& contact, std::size_t joint,
                                                         std::size_t count) {
    if (joint >= contact.nut_bodies.size() || !contact.nut_bodies[joint]) return {};
    const std::size_t shape = contact.world.bodies[*contact.nut_bodies[joint]].shape;
    auto samples = collision::sample_outer_surface(contact.world.shapes[shape].solid, count);
    constexpr double face_tolerance = 1e-4;  // m, of a bearing face that is not exactly at 0
    std::erase_if(samples,
                  [](const collision::SurfacePoint& sample) { return sample.at.z < -face_tolerance; });
    return samples;
}

bool occluded(const ToolContact& contact, const Vec3& from, const Vec3& to, int joint) {
    const auto i = static_cast<std::size_t>(joint);
    const bool has_mesh = joint >= 0 && i < contact.nut_bodies.size();
    return collision::occluded(contact.world, from, to, has_mesh ? contact.nut_bodies[i] : std::nullopt);
}

}  // namespace bolt::servo
