// The hand in the glove at a station: what the glove told becomes a hand that closes on the tool and takes
// it, keeps it while the glove is lost, and lets it go when it opens. Pure; allocates nothing. It costs what
// `grip::step` costs: for the rate of the glove, not for the servo's tick.
//
// Nothing tells where the hand is but the device that moves the tool: the tool comes along in the open hand,
// and is felt from when the hand has closed on it.
#pragma once

#include <string>

#include "haptics/glove/driver.hpp"
#include "haptics/glove/gloved_hand.hpp"
#include "haptics/grip/grip.hpp"
#include "haptics/servo/io.hpp"

namespace bolt::station {

struct HandPlan {
    glove::Wearer wearer;
    contact::ToolShape tool;
    Pose wrist;  // in the frame of the tool, where the mover has that
    grip::GripOptions grip;
};

// In the assembly's frame.
struct ToolPlace {
    Pose wished;  // where the mover has it
    Pose now;     // where obstacles let it be
};

struct HandState {
    glove::GlovedHand gloved;
    grip::Grip grip;
    std::uint64_t number = 0;  // of the last sample
};

// The newest sample of the glove, which may be one that was told before.
grip::Told hand_step(const HandPlan& plan, HandState& state, const glove::Sample& sample,
                     const ToolPlace& place, double dt);

// What the servo takes it for.
constexpr servo::Grip grip_of(const HandState& state) {
    return state.grip.held ? servo::Grip::wrench : servo::Grip::none;
}

// For a picture. In the frame of the tool: so it goes with Output::tool of every tick.
struct ShownHand {
    hand::Skeleton joints;
    hand::Side side = hand::Side::right;
    bool any = false;  // the glove said how it is bent
    bool held = false, lost = false;
};
ShownHand shown(const HandPlan& plan, const HandState& state);

// What is wrong with it, with the hand that wears it and with its line, worst first.
struct HandTrouble {
    bool held = false, lost = false;
};
std::vector<std::string> words(const HandTrouble& hand, hand::Side worn, const glove::Report& report);

}  // namespace bolt::station
