// The wrench in the hand among what it can bump into: casing, bolts and the nuts themselves, which turn and
// come down as their joints do. The wrench that is worked with is the one that contact lets through
// (contact/god_object.hpp); what is felt of the contact is the coupling between that one and the hand.
//
// Jaw against nut is closed form (contact/jaw.hpp), from the first touch until the jaw is off again; whatever
// else of the wrench meets a nut meets its mesh, and everything that is no nut meets all of the wrench's.
#pragma once

#include <array>
#include <optional>

#include "engine/base/result.hpp"
#include "haptics/contact/god_object.hpp"
#include "haptics/contact/proximity.hpp"
#include "haptics/force/passivity.hpp"
#include "haptics/servo/setup.hpp"

namespace bolt::servo {

// What is touched. Still obstacles lie in the assembly's frame, nuts in their own (nut_pose in setup.hpp).
// Nuts without a mesh are touched by the jaw alone.
struct TouchDescription {
    std::span<const contact::ContactMesh> still;
    std::span<const contact::ContactMesh> nuts;    // by joint; a mesh without triangles: none
    std::span<const contact::ContactMesh> wrench;  // in the tool's frame
    double friction = 0.15;                        // steel on painted iron, oiled by use
};

// Ids of obstacles: what stands still in the order given, and from here on the nuts by joint.
inline constexpr std::int32_t first_nut = 1000;

// What was found last, and for what: contacts of the jaw with nuts first, then those of meshes.
struct LastFound {
    // Nothing that they are with has moved since.
    bool nuts_hold = false, meshes_hold = false;
    Pose pose;
    double band = 0.0;
    contact::Found nuts, meshes;
    std::size_t count = 0;
    std::array<contact::Contact, contact::most_contacts> contacts;
};

struct Touch {
    contact::World world;
    contact::ToolShape wrench;
    contact::ProximityState proximity;
    contact::GodObjectParameters parameters;
    contact::GodObjectState god_object;
    std::vector<std::optional<std::size_t>> nuts;  // by joint: index of its body
    std::vector<contact::Convex> hexagons;         // by joint
    std::vector<Pose> places;                      // by joint: where its nut is now
    contact::JawParts jaw;
    int around = -1;              // joint whose nut the jaw sits on, held or slipping; −1: none
    contact::GodObjectStep last;  // what the last tick did
    LastFound found;
    bool in_hand = false;       // the wrench was held in the last tick
    std::int32_t touched = -1;  // id of the obstacle that it lies against; −1: none
};

// All that allocates. An error: a mesh that is not closed (contact/tool.hpp, contact/world.hpp).
Result<Touch> make_touch(const Setup& setup, const TouchDescription& description);

// The coupling that the device and the rate of the ticks allow; part of `make_touch`.
void set_coupling(const Setup& setup, Touch& touch);

// One tick: nuts go where their joints are, the wrench follows the hand as far as it may. `held_nut`: the
// joint whose nut the jaw holds; with it the hexagon turns, so contacts do not resist that turn and the joint
// does (jaw_grip.hpp); −1: none. Not held, the wrench is where the hand is, and nothing is felt.
force::Wanted step_touch(const Setup& setup, Touch& touch, std::span<const joint::JointState> joints,
                         const Pose& hand, bool held, int held_nut);

// Whether an obstacle other than this joint's nut lies between two points.
bool hidden(const Touch& touch, const Vec3& from, const Vec3& to, int joint);

}  // namespace bolt::servo
