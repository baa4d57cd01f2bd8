// Contact of fingertips with a tool, and whether they hold it.
#pragma once

#include <array>

#include "haptics/collision/world.hpp"

namespace bolt::hand {

// Thumb first, then index to little finger.
inline constexpr std::size_t fingers = 5;

struct Fingertips {
    std::array<Vec3, fingers> at{};  // m, centres of the fingertip pads, tool frame
    double radius = 8e-3;            // m, of a pad modelled as a sphere
};

struct FingertipContact {
    double distance =
        collision::infinite_distance;  // m, signed, from pad to tool; infinite_distance beyond `sight`
    Vec3 point{0.0};                   // m, on the tool's surface, tool frame
    Vec3 normal{0.0};                  // unit, outward there
};

struct FingertipGrasp {
    std::array<FingertipContact, fingers> tips;
    bool held = false;  // the thumb and another finger press from opposite sides
};

inline constexpr double sight = 50e-3;    // m, range of the query
inline constexpr double touching = 2e-3;  // m: compliance of the pads plus error of the glove

// Two soft contacts hold an object if the line between them lies in both friction cones (Nguyen, Int. J.
// Robotics Research 7(3), 1988). 45° is the upper bound for skin on dry steel: the simulation must not drop
// what a hand would hold.
inline constexpr double friction_angle = pi / 4.0;

FingertipGrasp fingertip_grasp(const collision::ToolShape& tool, const Fingertips& tips);

}  // namespace bolt::hand
