// Ranges of the joints of a hand. Readings beyond them are errors of the glove and would show a broken
// finger.
//
// Sources: the American Academy of Orthopaedic Surgeons (Joint Motion: Method of Measuring and
// Recording, 1965), a PIP of 110° as in J. Lin, Y. Wu, T. S. Huang, Modeling the constraints of human hand
// motion (IEEE Workshop on Human Motion, 2000); of the carpometacarpal joints those of M. El-shennawy et al.
// (J. Hand Surg. 26A(6), 2001, 1030-1035). They are population means, so `margin` is added on both sides.
#pragma once

#include "engine/base/math.hpp"
#include "haptics/hand/angles.hpp"

namespace bolt::hand {

struct Span {
    double low = 0.0, high = 0.0;  // rad
};

inline constexpr double margin = to_radians(10.0);

constexpr Span degrees(double low, double high) {
    return {to_radians(low) - margin, to_radians(high) + margin};
}

inline constexpr Span mcp_span = degrees(-45.0, 90.0);
inline constexpr Span pip_span = degrees(0.0, 110.0);
inline constexpr Span dip_span = degrees(0.0, 90.0);
inline constexpr Span side_span = degrees(-10.0, 20.0);
inline constexpr Span thumb_roll_span = degrees(0.0, 90.0);
inline constexpr Span thumb_abduction_span = degrees(0.0, 60.0);
inline constexpr Span thumb_mcp_span = degrees(0.0, 50.0);
inline constexpr Span thumb_ip_span = degrees(-20.0, 80.0);
inline constexpr Span arch_span = degrees(0.0, 27.0);
inline constexpr Span wrist_flexion_span = degrees(-70.0, 80.0);
inline constexpr Span wrist_side_span = degrees(-30.0, 20.0);

// Clamps each angle to its range; NaN becomes 0. The abduction range of a finger decreases linearly to zero
// at 90° of MCP flexion (I. A. Kapandji, The Physiology of the Joints, vol. 1, on the collateral ligaments;
// linear by assumption).
Angles clamp_to_limits(const Angles& angles);

}  // namespace bolt::hand
