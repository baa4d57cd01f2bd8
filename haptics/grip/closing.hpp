// Fingers that close on a tool and not through it: a glove knows nothing of what is in the hand.
//
// A digit is taken from open to as bent as it was measured, all its joints at once, and stops where it first
// touches. Open is a straight finger, a straight thumb as far from the index finger as it goes. Joints beyond
// the part that touches go on: so a finger wraps around a handle. Conservative advancement (B. Mirtich,
// Impulse-based dynamic simulation of rigid body systems, 1996) by the distance to the tool and by how far a
// part can move: nothing is jumped over, however thin it is. Allocates nothing.
#pragma once

#include "haptics/contact/grasp.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::grip {

// Distances are to balls along the bones, this far apart at most (m): what lies between two can be deeper by
// 0.6 mm in the narrowest finger.
inline constexpr double ball_spacing = 6e-3;
inline constexpr double stop_tolerance = 50e-6;  // m that a ball may be in the tool where its digit stopped
inline constexpr int most_steps = 200;           // of a digit; after them it stays where it has come to

struct DigitStop {
    // What is shown of the bend of its three joints, 0 … 1: knuckle to last; of the thumb abduction, MCP, IP.
    std::array<double, 3> share{1.0, 1.0, 1.0};
    bool touches = false;
    // Of its last two parts, where they are nearest to the tool, as `contact::grasp` has it.
    contact::FingertipContact nearest;
    int steps = 0;
};

struct Closing {
    hand::Angles shown;
    std::array<DigitStop, hand::digit_count> digits;
};

// `wrist`: in the frame of the tool. What is in the tool with the digit open does not keep it from
// bending, but being deeper does.
Closing close_on(const contact::ToolShape& tool, const hand::Hand& hand, const hand::Angles& measured,
                 const Pose& wrist);

}  // namespace bolt::grip
