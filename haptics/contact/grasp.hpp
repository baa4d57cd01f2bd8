// Where fingertips lie on a tool: which of them touch it, and whether they hold it.
#pragma once

#include <array>

#include "haptics/contact/tool.hpp"

namespace bolt::contact {

// Thumb first, then index to little finger.
inline constexpr std::size_t fingers = 5;

struct Fingertips {
    std::array<Vec3, fingers> at{};  // m, middles of the fingertip pads, in the tool's frame
    double radius = 8e-3;            // m, of a pad taken as a ball
};

struct FingertipContact {
    double distance = nothing_near;  // m, of the pad to the tool, signed; nothing_near beyond `sight`
    Vec3 point{0.0};                 // m, on the tool's surface, in its frame
    Vec3 normal{0.0};                // unit, outward there
};

struct Grasp {
    std::array<FingertipContact, fingers> tips;
    bool held = false;  // the thumb and another finger press from opposite sides
};

inline constexpr double sight = 50e-3;    // m: what is further from a pad is not looked for
inline constexpr double touching = 2e-3;  // m: soft pads give, and gloves err by so much

// Two soft contacts hold a thing when the line between them lies in both friction cones (Nguyen, Int. J.
// Robotics Research 7(3), 1988). Taken as 45°: what skin has on dry steel at best, for a glove must not drop
// what a hand would hold.
inline constexpr double friction_angle = pi / 4.0;

Grasp grasp(const ToolShape& tool, const Fingertips& tips);

}  // namespace bolt::contact
