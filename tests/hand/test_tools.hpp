// Tools for tests of a hand at a handle, and brute-force measurements of penetration.
#pragma once

#include "haptics/hand/grasp.hpp"
#include "haptics/hand/kinematics.hpp"
#include "tests/collision/support.hpp"

namespace grasp_test {

using namespace bolt;

struct TestTool {
    collision::ToolShape tool;
    contact_test::ClosedSurface surface;
};

// A flat bar like a wrench's handle: 230 mm long along x, 24 mm by 7 mm.
TestTool bar();
TestTool of(const std::vector<collision::ContactMesh>& parts);

// Pose of the right wrist in the frame of a bar that lies across the palm and protrudes on the thumb's side.
Pose across_the_palm();
// Angles of a closed hand. `share`: 0 flat and open, 1 a fist without anything in it.
inline hand::Angles closed(double share) { return hand::closed_hand_angles(share); }

// Penetration depth of a digit, m, at points 1 mm apart along its bones; negative outside the tool.
double deepest(const TestTool& held, const hand::Hand& hand, const Pose& wrist, std::size_t digit,
               const hand::Angles& angles);
// The greatest increase of a point's depth from the angles `than` to `angles`, m.
double deeper(const TestTool& held, const hand::Hand& hand, const Pose& wrist, std::size_t digit,
              const hand::Angles& angles, const hand::Angles& than);

// The angles before closing begins.
hand::Angles opened(const hand::Angles& angles);

}  // namespace grasp_test
