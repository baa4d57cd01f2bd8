// The state of the work as components: plain data that haptic_system writes from the servo's snapshot after
// each tick. HUD, sound, hints, lesson and drawing read it here. A world without pictures has only these
// components; the scene adds its own (WorldWith). Lengths in m, angles in rad, forces in N, torques in N·m,
// poses in the assembly's frame.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "engine/base/math.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/ecs/system.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/joint/stage.hpp"
#include "haptics/servo/io.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::world {

// A bolted joint; one entity for each joint of the assembly.
struct Joint {
    std::size_t index = 0;  // in the assembly
    joint::Stage stage = joint::Stage::navigation;
    joint::Condition condition = joint::Condition::sound;
    double angle = 0.0;    // of the nut from its hand-started position, tightening positive
    double speed = 0.0;    // rad/s of the nut
    double torque = 0.0;   // of wrench or fingers on the nut, tightening positive
    double clamp = 0.0;    // bolt force
    double rounded = 0.0;  // m that slipping jaws have worn off each corner of the nut
};

// The tool at the pose that the obstacles allow: the wrench in the hand, or the fingertips of an empty hand.
struct Tool {
    Pose pose;
};

// What the tool touches and holds. −1: none.
struct ToolContact {
    std::int16_t joint = -1;         // engaged joint
    std::int16_t slipped = -1;       // joint over whose corners the jaw slipped in this tick
    collision::ObstacleId obstacle;  // that the wrench lies against
    std::uint16_t contacts = 0;      // active and nearly active contacts
    bool clicked = false;            // the torque wrench clicked in this tick
};

// The force that leads the tool to a nut, before the output stage limits it.
struct GuidingForce {
    std::int16_t joint = -1;  // goal; −1: none
    Vec3 force{0.0};
    Vec3 torque{0.0};
};

// What the device renders, after scaling and limits.
struct DeviceForce {
    Vec3 force{0.0};
    Vec3 torque{0.0};
    force::Fault fault = force::Fault::none;  // why it renders nothing
};

enum class Doing : std::uint8_t {
    resting,    // the hand waits where it is
    reaching,   // moves to a nut, to the wrench or to the place where the wrench is laid down
    lowering,   // onto a nut
    holding,    // holds a nut with the wrench or the fingers
    easing,     // lets the wrench spring back before it comes off
    lifting,    // off a nut
    returning,  // fingers go back for the next twist
};

// The hand that works, moved by a mouse, a device or a recorded session.
struct Hand {
    Doing doing = Doing::resting;
    bool wrench = false;             // the wrench is in the hand
    bool pinches = false;            // fingers close on a nut
    std::optional<std::size_t> nut;  // joint that the hand moves to, is at or holds
    Pose pose;                       // of the tool or the empty hand, as the hand asks for it
    Pose to;                         // end of a reach
    Pose rest;                       // where the wrench lies while it is not in the hand
    double twisted = 0.0;            // by the fingers since they took the nut
    double room = std::numeric_limits<double>::infinity();  // that the hand can still turn what it holds
};

// The measured fingers of a hand that wears a glove; only then the hand's entity has it.
struct GloveHand {
    hand::Skeleton fingers;  // 26 joints in the frame of the wrench, in the hand or where it lies
    bool lost = false;       // the glove sends no valid samples
};

// These components and those of whoever shows them.
template <class... More>
using WorldWith =
    ecs::Registry<Joint, Tool, ToolContact, GuidingForce, DeviceForce, Hand, GloveHand, More...>;
using World = WorldWith<>;

// From the servo's snapshot to components. Every program that shows or plays a lesson does this after a tick,
// before anything else reads the world: the windowed trainer, headless lessons, replays and films.

using ReadHaptics = ecs::Access<const Joint, const Tool, const ToolContact, const GuidingForce,
                                const DeviceForce, const Hand>;
using WriteHaptics = ecs::Access<Joint, Tool, ToolContact, GuidingForce, DeviceForce, Hand>;

// The servo after a tick.
struct Snapshot {
    const servo::State& state;
    const servo::Input& input;
    const servo::Output& output;
};

// Writes every component from the snapshot. The hand is where the input has it and holds what is engaged;
// Hand::rest stays. A program that knows more of the hand (where it moves, a glove) writes that afterwards.
void write_snapshot(const WriteHaptics& world, const Snapshot& servo);

// Its parts. `rounded` may be empty: no corner is worn.
void write_joints(const WriteHaptics& world, std::span<const joint::JointState> joints,
                  std::span<const double> rounded);
void write_output(const WriteHaptics& world, const servo::Output& output);

// Creates the entities: one for each joint, one for the tool, one for the hand. `rest`: where the wrench
// lies.
template <class Registry>
void add_haptics(Registry& world, const servo::State& state, const Pose& rest = {}) {
    for (std::size_t i = 0; i < state.joints.size(); ++i) world.template add<Joint>(world.create()).index = i;
    const ecs::Entity tool = world.create();
    world.template add<Tool>(tool);
    world.template add<ToolContact>(tool);
    world.template add<GuidingForce>(tool);
    world.template add<DeviceForce>(tool);
    world.template add<Hand>(world.create()).rest = rest;
    write_joints(world, state.joints, state.rounded);
}

// Returns the joint with this index, which must exist.
const Joint& joint_at(const ecs::Access<const Joint>& world, std::size_t index);

// Centre of a joint's nut, which comes down as it turns.
Vec3 nut_centre(const ecs::Access<const Joint>& world, const servo::Setup& setup, std::size_t joint);

}  // namespace bolt::world
