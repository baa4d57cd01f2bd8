// A world as haptic_system writes it, for tests that set the servo's values by hand.
#pragma once

#include "game/world/world.hpp"

namespace bolt::test {

class HapticWorld {
  public:
    explicit HapticWorld(std::size_t joints) {
        state_.joints.resize(joints);
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
        return write(state_.joints, {}, output, wrench);
    }

    const world::World& write(std::span<const joint::JointState> joints, std::span<const double> rounded,
                              const servo::Output& output, bool wrench,
                              double room = std::numeric_limits<double>::infinity()) {
        world::write_joints(world_, joints, rounded);
        world::write_output(world_, output);
        world::WorkingHand& hand = world_.only<world::WorkingHand>();
        hand.wrench = wrench;
        hand.action = world::HandAction::holding;
        hand.room = room;
        return world_;
    }

  private:
    servo::State state_;
    world::World world_;
};

}  // namespace bolt::test
