// Closes the fingers on the tool without penetration; the glove does not sense the tool.
//
// Each digit moves from open to its measured flexion, all joints in proportion, and stops at first contact.
// Open is a straight finger, or a straight thumb at full abduction. Joints beyond the touching bone continue,
// so the finger wraps around a handle. Conservative advancement (B. Mirtich, Impulse-based dynamic simulation
// of rigid body systems, 1996) steps by the distance to the tool divided by the speed bound, so thin parts
// are not skipped. Allocates nothing.
#pragma once

#include "haptics/hand/fingertip_contact.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {

// Greatest spacing (m) of the spheres along the bones that distances are measured from. Between two spheres
// the penetration can be 0.6 mm deeper in the narrowest finger.
inline constexpr double ball_spacing = 6e-3;
inline constexpr double stop_tolerance = 50e-6;  // m, penetration tolerated where a digit stops
inline constexpr int max_steps = 200;            // per digit; it then stays where it is

struct DigitStop {
    // Fraction 0 … 1 of the measured flexion reached by MCP, PIP, DIP; for the thumb by abduction, MCP, IP.
    std::array<double, 3> share{1.0, 1.0, 1.0};
    bool touches = false;
    // The nearest point of its last two bones to the tool.
    hand::FingertipContact nearest;
    int steps = 0;
};

struct FingerClosure {
    hand::Angles angles;
    std::array<DigitStop, hand::digit_count> digits;
};

// `wrist` is in the tool frame. A bone that already penetrates with the digit open does not stop it; deeper
// penetration does.
FingerClosure close_fingers(const collision::ToolShape& tool, const hand::Hand& hand,
                            const hand::Angles& measured, const Pose& wrist);

}  // namespace bolt::hand
