// Whether the hand in the glove holds the tool: it takes it when thumb and fingers close on it, and lets go
// when they are away from it for a while. What is held stays held when the glove is lost. Pure: a step of
// fixed dt. It costs what `close_on` costs whenever glove or hand have moved: made for the rate of the glove
// and of the frames, not for the servo's tick.
#pragma once

#include "haptics/grip/closing.hpp"

namespace bolt::grip {

struct GripOptions {
    std::size_t fingers = 2;     // that touch, for it to be taken; the thumb opposes one or all of them
    double take_after = 0.03;    // s that it is so
    double away = 6e-3;          // m: a thumb, or all fingers, beyond that let go
    double let_go_after = 0.15;  // s that they are
    double silence = 0.1;        // s without a frame: the glove is lost
    double think = 0.5;          // s after it is back in which nothing is let go
};

struct GripInput {
    bool fresh = false;     // a frame of the glove came since the last step
    hand::Angles measured;  // of that frame
    Pose wrist;             // of the hand that is not held: in the frame of the tool
};

// What the trainee is told, once each.
enum class Told : std::uint8_t { nothing, taken, let_go, glove_lost, glove_back };
// "": nothing. What it says of a lost glove depends on whether something is held.
const char* words(Told told, bool held);

struct Grip {
    bool held = false;
    bool lost = false;      // the glove
    Pose wrist;             // in the frame of the tool; while it is held the one that it was taken with
    hand::Angles measured;  // the last that came
    Closing closing;        // what is to be shown
    bool grasping = false;  // the fingers are on it as they must be to take it

    bool any = false;           // a frame ever came
    double quiet = 0.0;         // s since the last one
    bool contrary = false;      // the fingers do the contrary of what is held to be
    double contrary_for = 0.0;  // s that they have, from frame to frame
    double undecided = 0.0;     // s of `think` left
};

Told step(Grip& grip, const GripOptions& options, const contact::ToolShape& tool, const hand::Hand& hand,
          const GripInput& input, double dt);

}  // namespace bolt::grip
