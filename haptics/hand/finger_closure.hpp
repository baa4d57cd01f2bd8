// Contact of the digits with a tool: whether fingertips hold it, and how far the fingers close on it.
#pragma once

#include <array>

#include "haptics/collision/world.hpp"
#include "haptics/hand/kinematics.hpp"

namespace bolt::hand {

struct Fingertips {
    std::array<Vec3, digit_count> at{};  // m, centres of the fingertip pads, tool frame
    double radius = 8e-3;                // m, of a pad modelled as a sphere
};

struct FingertipContact {
    // m, signed, from pad to tool; infinite_distance if the tool is beyond the range of the query.
    double distance = collision::infinite_distance;
    Vec3 point{0.0};   // m, on the tool's surface, tool frame
    Vec3 normal{0.0};  // unit, outward, at `point`
};

struct FingertipGrasp {
    std::array<FingertipContact, digit_count> tips;
    bool held = false;  // thumb and another finger press from opposite sides
};

inline constexpr double contact_query_range = 50e-3;  // m, range of the query
// m; a nearer fingertip touches. Covers the compliance of the pads and the error of the glove.
inline constexpr double touch_distance = 2e-3;

// Two soft contacts hold an object if the line between them lies in both friction cones (Nguyen, Int. J.
// Robotics Research 7(3), 1988). 45° is the upper bound for skin on dry steel, so that the simulation does
// not drop a tool that a hand would hold.
inline constexpr double friction_angle = pi / 4.0;

FingertipGrasp fingertip_grasp(const collision::ToolShape& tool, const Fingertips& tips);

// Finger closure: closes the fingers on the tool without penetration, because the glove does not sense the
// tool.
//
// Each digit moves from open to its measured flexion, all joints in proportion, and stops at first contact.
// Open is a straight finger, or a straight thumb at full abduction. Joints beyond the touching bone continue,
// so the finger wraps around a handle. Conservative advancement (B. Mirtich, Impulse-based dynamic simulation
// of rigid body systems, 1996) steps by the distance to the tool divided by the speed bound, so thin parts
// are not skipped. Allocates nothing.

// m, greatest spacing of the spheres along the bones from which distances are measured. Between two spheres
// the penetration can be 0.6 mm deeper in the narrowest finger.
inline constexpr double sphere_spacing = 6e-3;
inline constexpr double stop_tolerance = 50e-6;  // m, penetration tolerated where a digit stops
inline constexpr int max_steps = 200;            // per digit, which then stops

struct DigitStop {
    // Fraction 0 … 1 of the measured flexion reached by MCP, PIP, DIP; for the thumb by abduction, MCP, IP.
    std::array<double, 3> share{1.0, 1.0, 1.0};
    bool touches = false;
    // Nearest point of the tool to the digit's last two bones.
    FingertipContact nearest;
    int steps = 0;
};

struct FingerClosure {
    Angles angles;
    std::array<DigitStop, digit_count> digits;
};

// `wrist` is in the tool frame. Penetration that exists while the digit is open is tolerated; only deeper
// penetration stops the digit.
FingerClosure close_fingers(const collision::ToolShape& tool, const Hand& hand, const Angles& measured,
                            const Pose& wrist);

}  // namespace bolt::hand
