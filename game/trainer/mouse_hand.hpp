// A hand that somebody moves with a mouse: they point at a nut and press, and it goes there, takes the nut or
// puts the wrench on it, and is pulled while the button is held; let go, it comes off. What a mouse cannot
// say (how to get round the casing, from which side a handle has room) the hand finds out by itself, as a
// hand does. Pure: it has no clock, and gives the servo poses like any other hand.
#pragma once

#include <optional>
#include <vector>

#include "game/lesson/lesson.hpp"
#include "game/world/world.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::trainer {

using world::Doing;
using world::Hand;

// What the mouse wants; filled in once a frame.
struct Wish {
    std::optional<std::size_t> nut;  // pressed on this one since the last frame
    bool wrench = false;             // pressed on the wrench that lies there, or its key: take it
    bool lay_down = false;
    bool retreat = false;  // out of the way, with what it holds
    bool held = false;     // the button is down
    bool loosens = false;  // which way the next pull goes: for the side that a handle needs room on
    double turn = 0.0;     // rad that the handle was dragged since the last frame, tightening positive
    double spin = 0.0;     // −1 … 1 of the fastest twist, by fingers
};

struct MouseHand {
    Doing doing = Doing::resting;
    bool wrench = false;             // is in the hand
    std::optional<std::size_t> nut;  // that it goes to, or has
    Pose pose;                       // of the tool, in the assembly's frame
    Pose rest;                       // where the wrench lies, and the hand waits without it
    double nearer = -1.0;            // along the y of `rest`: the way to whoever works
    double handle = 0.0;             // rad, of the handle about the bolt
    bool flipped = false;
    double room = 0.0;   // rad that the handle may swing in this pull
    double above = 0.0;  // m over the nut, where it waits

    double begun_at = 0.0;    // rad, where the pull or the twist began
    double twisted_to = 0.0;  // rad, where the fingers go back from
    bool held = false, loosens = false;
    double turn = 0.0, spin = 0.0;    // that are still to be done
    Pose from, to;                    // of the movement
    Vec3 bulge{0.0};                  // m, how far it goes off the straight way
    std::vector<Pose> stations;       // that it goes to after `to`, the last first
    double time = 0.0, length = 0.0;  // s, of the movement
    enum class Then : std::uint8_t { rest, take, lay_down, lower } then = Then::rest;
    std::optional<std::size_t> next;  // was pressed on while the hand was busy
    bool missed = false;              // the last try did not get hold of the nut, or lost it
    int misses = 0;                   // times in a row: the next try goes higher, and to another side
};

// The hand at rest where the wrench lies: the left one where that lies for it (scene::resting_place).
MouseHand make_hand(const Pose& rest, hand::Side side = hand::Side::right);

Hand hand_of(const MouseHand& hand);

void wish(MouseHand& hand, const Wish& wish, const servo::Setup& setup, const servo::State& state);

// Where the wrench that lies there would be put on a nut now.
Pose wrench_on(const Pose& rest, const servo::Setup& setup, const servo::State& state, std::size_t joint,
               bool loosens);

// One tick. Without the guiding force: `guide` is the lesson's to fill in.
servo::Input move(MouseHand& hand, const servo::Setup& setup, const servo::State& state);

}  // namespace bolt::trainer
