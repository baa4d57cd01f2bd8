// Worlds as world::write_haptics writes them, for tests that step a servo or set its values by hand.
#pragma once

#include "game/lesson/lesson.hpp"
#include "game/world/world.hpp"

namespace bolt::test {

inline world::World make_world(const servo::State& state) {
    world::World world;
    world::add_haptics(world, state);
    return world;
}

// Runs the systems that follow a tick (session::tick_systems), without undo.
inline void observe_tick(lesson::Lesson& lesson, world::World& world, const servo::State& state,
                         const servo::Output& output) {
    world::write_haptics(world, {state, {}, output});
    lesson::observe(lesson, world);
}

class HapticWorld {
  public:
    explicit HapticWorld(std::size_t joints) {
        state_.joints.resize(joints);
        state_.rounded.resize(joints);
        world::add_haptics(world_, state_);
    }

    // Writes an output, and its values for the engaged joint into that joint; all other joints are unchanged.
    const world::World& write(const servo::Output& output, bool wrench = true) {
        if (output.joint >= 0) {
            joint::JointState& joint = state_.joints.at(static_cast<std::size_t>(output.joint));
            joint.nut.angle = output.nut_angle;
            joint.torque = output.wrench_torque;
            joint.clamp = output.clamp;
            joint.stage = output.stage;
        }
        return write(state_, output, wrench);
    }

    const world::World& write(const servo::State& state, const servo::Output& output, bool wrench,
                              double free_swing = std::numeric_limits<double>::infinity()) {
        world::write_haptics(world_, {state, {}, output});
        world::WorkingHand& hand = world_.only<world::WorkingHand>();
        hand.wrench = wrench;
        hand.action = world::HandAction::holding;
        hand.free_swing = free_swing;
        return world_;
    }

  private:
    servo::State state_;
    world::World world_;
};

}  // namespace bolt::test
