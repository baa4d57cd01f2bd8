// A hand at a handle, and answers about it by brute force.
#pragma once

#include "haptics/hand/grasp.hpp"
#include "haptics/hand/kinematics.hpp"
#include "tests/collision/support.hpp"

namespace grasp_test {

using namespace bolt;

inline constexpr double mm = 1e-3;

struct TestTool {
    collision::ToolShape tool;
    contact_test::Surface surface;
};

// A flat bar as a wrench's handle is: 230 mm long along x, 24 mm by 7 mm.
TestTool bar();
TestTool of(const std::vector<collision::ContactMesh>& parts);

// The right hand's wrist in the frame of a bar that lies across its palm, from the thumb's side out.
Pose across_the_palm();
// Fingers and thumb so far closed: 0 flat and open, 1 a hand that would be a fist, were nothing in it.
inline hand::Angles closed(double share) { return hand::closed_hand_angles(share); }

// How deep a digit is in the tool (m), at points 1 mm apart along its bones; below 0 it is not.
double deepest(const TestTool& held, const hand::Hand& hand, const Pose& wrist, std::size_t digit,
               const hand::Angles& angles);
// The same of what each point is deeper than with the other angles.
double deeper(const TestTool& held, const hand::Hand& hand, const Pose& wrist, std::size_t digit,
              const hand::Angles& angles, const hand::Angles& than);

// As the digit is before it begins to close.
hand::Angles opened(const hand::Angles& angles);

}  // namespace grasp_test
