// Contact of the wrench with its surroundings: housing, bolts and nuts. Nuts turn and descend with their
// joints. The god-object (haptics/proxy/god_object.hpp) limits the wrench to poses without penetration; the
// hand feels the coupling between the commanded and the constrained pose.
//
// Contact between the tool's head and a nut that it can turn is closed form
// (haptics/collision/tool_head.hpp), from the first contact until the head is clear of the nut. The other
// parts of the tool are tested against the nut's mesh, and the whole tool against all other obstacles.
#pragma once

#include <array>
#include <optional>

#include "engine/base/result.hpp"
#include "haptics/collision/narrow_phase.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/proxy/god_object.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::servo {

// Fixed obstacles are in the assembly's frame, nuts in their own (nut_pose in setup.hpp).
struct ToolContactDescription {
    std::span<const collision::ContactMesh> fixed;
    // By joint. An empty mesh: this nut is tested against the tool's head only.
    std::span<const collision::ContactMesh> nuts;
    // By tool of the setup, in the tool's frame.
    std::span<const std::vector<collision::ContactMesh>> tools;
    double friction_coefficient = 0.15;  // steel on painted iron with a film of oil
};

// The last query: its pose and band, and its contacts, first those of the head with nuts, then those of
// meshes.
struct ContactCache {
    // No nut has moved since the query, so the head's contacts are still valid.
    bool nuts_unchanged = false;
    // No body has moved, been enabled or been disabled since the query, so the mesh contacts are still valid.
    bool meshes_unchanged = false;
    Pose pose;
    double band = 0.0;                           // m, distance up to which contacts were searched
    collision::ContactQueryResult nuts, meshes;  // results for the head with nuts, and for the meshes
    std::size_t count = 0;                       // number of `contacts`
    std::array<collision::Contact, proxy::max_contacts> contacts;
};

// The shape of a tool, and the data of contact queries that belong to this tool.
struct ToolInContact {
    collision::ToolShape shape;
    collision::NarrowPhaseState narrow_phase;
    std::vector<collision::Convex> head;  // convex solids of the tool's head
    // By joint: convex solids of the nut or of the screw's socket. Empty: the head cannot turn it.
    std::vector<std::vector<collision::Convex>> shape_solids;
    std::vector<double> grip_reach;  // m by joint, of `head` and `shape_solids`
};

// The arguments of nut_pose().
struct NutAngles {
    double nut_angle = 0.0, common_turn = 0.0;  // rad
    bool operator==(const NutAngles&) const = default;
};

struct ToolContact {
    collision::CollisionWorld world;
    // The next five members belong to the tool in use, as in ToolInContact.
    collision::ToolShape wrench;
    collision::NarrowPhaseState narrow_phase;
    std::vector<collision::Convex> head;
    std::vector<std::vector<collision::Convex>> shape_solids;
    std::vector<double> grip_reach;
    // By tool of the setup. The entry of the tool in use is empty: its data are in the five members above.
    std::vector<ToolInContact> tools;
    proxy::GodObjectParameters parameters;
    proxy::GodObjectState god_object;
    std::vector<std::optional<std::size_t>> nut_bodies;  // by joint: index into world.bodies; none: no mesh
    std::vector<collision::TurnedShape> shapes;          // by joint: the hexagon or socket that a tool turns
    std::vector<Pose> nut_poses;                         // by joint, in the assembly's frame
    std::vector<NutAngles> nut_angles;                   // by joint: the angles that `nut_poses` belong to
    // Joint whose nut the tool's head holds, or has released and is not yet clear of; −1: none.
    int joint_at_head = -1;
    proxy::GodObjectStep last_step;  // result of the last tick
    ContactCache cache;
    bool in_hand = false;           // the wrench was held in the last tick
    collision::ObstacleId touched;  // the nearest obstacle in contact, see Output::touched
};

// Builds the collision structures. Only this function and turned_part_samples() allocate. Fails if the mesh
// of a tool is not closed.
Result<ToolContact> make_tool_contact(const Setup& setup, const ToolContactDescription& description);

// Makes tool `to` the one in use instead of tool `from`, both indices in Setup::tools. The hand must not hold
// a tool. Does not allocate.
void use_tool(ToolContact& contact, std::size_t from, std::size_t to);

// Derives the coupling from the device's limits and the tick's dt. Call it again when either changes.
void set_coupling(const Setup& setup, ToolContact& contact);

// One tick: places the nuts by their joints' angles and moves the wrench towards `commanded_tool` as far as
// contacts allow. `engaged_joint` is the joint whose nut the head holds, −1 for none: its hexagon is
// placed at the head's angle, so that contacts never resist the turning of the nut; the joint law does
// (engagement.hpp). If `held` is false, the
// constrained tool is set to the commanded pose without contact, and the returned request is zero.
force::ForceRequest step_tool_contact(const Setup& setup, ToolContact& contact,
                                      std::span<const joint::JointState> joints, const Pose& commanded_tool,
                                      bool held, int engaged_joint);

// Points on the outer surface of a joint's nut or head, in its own frame: without the shank of a screw, which
// lies below the bearing face. At most `count`; none without a mesh.
std::vector<collision::SurfacePoint> turned_part_samples(const ToolContact& contact, std::size_t joint,
                                                         std::size_t count);

// Returns true if an obstacle other than `joint`'s nut crosses the segment. `joint` −1 excludes no nut.
bool occluded(const ToolContact& contact, const Vec3& from, const Vec3& to, int joint);

}  // namespace bolt::servo
