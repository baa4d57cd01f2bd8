// From the servo's snapshot to components. Every program that shows or plays a lesson does this after a tick,
// before anything else reads the world: the windowed trainer, headless lessons, replays and films.
#pragma once

#include <span>

#include "game/world/components.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::world {

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
