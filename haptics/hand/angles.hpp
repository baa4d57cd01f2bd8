// How a hand is bent: what a glove measures and what the kinematics take. Angles in rad; all of them 0: flat,
// fingers and thumb straight and side by side in the plane of the palm. Flexion is positive to the palm.
#pragma once

#include <array>

namespace bolt::hand {

// The joints by their anatomical names: MCP the knuckle, PIP and DIP those beyond it.
struct FingerAngles {
    double mcp = 0.0, pip = 0.0, dip = 0.0;
    double side = 0.0;  // abduction: away from the middle finger; of that itself, to the little finger
};

struct ThumbAngles {
    double roll = 0.0;       // of the metacarpal about the length of the hand, across the palm
    double abduction = 0.0;  // of the metacarpal, away from the index finger
    double mcp = 0.0, ip = 0.0;
};

struct Angles {
    ThumbAngles thumb;
    std::array<FingerAngles, 4> fingers;  // index to little finger
    double arch = 0.0;                    // of the little finger's metacarpal towards the palm
    double wrist_flexion = 0.0;
    double wrist_side = 0.0;  // towards the thumb
};

}  // namespace bolt::hand
