// Joint angles of a hand in rad: the output of the glove, the input of the kinematics. All zero is a flat
// hand, fingers and thumb straight and side by side in the plane of the palm. Flexion towards the palm is
// positive.
#pragma once

#include <array>

namespace bolt::hand {

// Anatomical names: MCP is the knuckle, then PIP and DIP.
struct FingerAngles {
    double mcp = 0.0, pip = 0.0, dip = 0.0;
    double side =
        0.0;  // abduction, away from the middle finger; for the middle finger towards the little finger
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
