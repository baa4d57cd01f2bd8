// The hand: joint angles and their limits, the 26 joints of XR_EXT_hand_tracking, forward kinematics, and
// capsules for collision. Angles in rad; all zero is a flat hand, fingers and thumb straight and side by side
// in the plane of the palm. Flexion towards the palm is positive.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "engine/base/math.hpp"
#include "engine/base/side.hpp"

namespace bolt::hand {

// Anatomical names: MCP is the knuckle, then PIP and DIP.
struct FingerAngles {
    double mcp = 0.0, pip = 0.0, dip = 0.0;
    // Positive away from the middle finger; for the middle finger itself, positive towards the little finger.
    double abduction = 0.0;
};

struct ThumbAngles {
    double roll =
        0.0;  // the metacarpal turns about the length of the hand, so that the thumb crosses the palm
    double abduction = 0.0;  // of the metacarpal, away from the index finger
    double mcp = 0.0, ip = 0.0;
};

struct Angles {
    ThumbAngles thumb;
    std::array<FingerAngles, 4> fingers;  // index to little finger
    double arch = 0.0;                    // of the little finger's metacarpal towards the palm
    double wrist_flexion = 0.0;
    double wrist_deviation = 0.0;  // towards the thumb
};

// Ranges of the joints. Readings beyond them are errors of the glove and would display a broken finger.
//
// Sources: American Academy of Orthopaedic Surgeons, Joint Motion: Method of Measuring and Recording, 1965.
// PIP of 110°: J. Lin, Y. Wu, T. S. Huang, Modeling the constraints of human hand motion, IEEE Workshop on
// Human Motion, 2000. Carpometacarpal joints: M. El-shennawy et al., J. Hand Surg. 26A(6), 2001, 1030-1035.
// These ranges are population means, so `range_margin` is added on both sides.

struct AngleRange {
    double low = 0.0, high = 0.0;  // rad
};

inline constexpr double range_margin = to_radians(10.0);

// The range from `low` to `high`, both in degrees, widened by `range_margin` at both ends.
constexpr AngleRange joint_range_deg(double low, double high) {
    return {to_radians(low) - range_margin, to_radians(high) + range_margin};
}

inline constexpr AngleRange mcp_range = joint_range_deg(-45.0, 90.0);
inline constexpr AngleRange pip_range = joint_range_deg(0.0, 110.0);
inline constexpr AngleRange dip_range = joint_range_deg(0.0, 90.0);
inline constexpr AngleRange abduction_range = joint_range_deg(-10.0, 20.0);
inline constexpr AngleRange thumb_roll_range = joint_range_deg(0.0, 90.0);
inline constexpr AngleRange thumb_abduction_range = joint_range_deg(0.0, 60.0);
inline constexpr AngleRange thumb_mcp_range = joint_range_deg(0.0, 50.0);
inline constexpr AngleRange thumb_ip_range = joint_range_deg(-20.0, 80.0);
inline constexpr AngleRange arch_range = joint_range_deg(0.0, 27.0);
inline constexpr AngleRange wrist_flexion_range = joint_range_deg(-70.0, 80.0);
inline constexpr AngleRange wrist_deviation_range = joint_range_deg(-30.0, 20.0);

// Clamps each angle to its range; NaN becomes 0. The abduction range of a finger decreases linearly to zero
// at 90° of MCP flexion (I. A. Kapandji, The Physiology of the Joints, vol. 1, on the collateral ligaments;
// linear by assumption).
Angles clamp_to_limits(const Angles& angles);

// Angles of a hand that closes around a handle. `share` 0: open, the thumb opposite the fingers; 1: a fist.
// Values chosen within the ranges above.
inline Angles closed_hand_angles(double share) {
    Angles a;
    const auto bent = [&](double degrees) { return share * to_radians(degrees); };
    for (FingerAngles& f : a.fingers) f = {bent(70.0), bent(95.0), bent(60.0), 0.0};
    a.thumb = {to_radians(70.0), to_radians(60.0) - bent(48.0), bent(50.0), bent(65.0)};
    a.arch = to_radians(8.0);
    return a;
}

// The 26 joints of XR_EXT_hand_tracking (OpenXR 1.0, section 12.31) of a relaxed and of a flat hand. Frames
// of the extension: −Z from the wrist towards the tip along the bone that begins at the joint, +Y out of the
// back of the hand or the nail, +X to the right. Positions in m, in the frame of the wrist joint.
//
// Lengths of bones and of the soft tissue at the tips are plausible and near A. Buryanov, V. Kotiuk,
// Proportions of hand segments, Int. J. Morphol. 28(3), 2010, 755-758; they are not verified against that
// table. With a carpus of 32 mm the hand is 189 mm long, about the median of men.

using bolt::Side;

// In the order of XrHandJointEXT; glTF nodes have the same names in lower case.
enum Joint : std::size_t {
    palm,
    wrist,
    thumb_metacarpal,
    thumb_proximal,
    thumb_distal,
    thumb_tip,
    index_metacarpal,
    index_proximal,
    index_intermediate,
    index_distal,
    index_tip,
    middle_metacarpal,
    middle_proximal,
    middle_intermediate,
    middle_distal,
    middle_tip,
    ring_metacarpal,
    ring_proximal,
    ring_intermediate,
    ring_distal,
    ring_tip,
    little_metacarpal,
    little_proximal,
    little_intermediate,
    little_distal,
    little_tip,
    joint_count
};

inline constexpr std::array<std::string_view, joint_count> joint_names{"palm",
                                                                       "wrist",
                                                                       "thumb_metacarpal",
                                                                       "thumb_proximal",
                                                                       "thumb_distal",
                                                                       "thumb_tip",
                                                                       "index_metacarpal",
                                                                       "index_proximal",
                                                                       "index_intermediate",
                                                                       "index_distal",
                                                                       "index_tip",
                                                                       "middle_metacarpal",
                                                                       "middle_proximal",
                                                                       "middle_intermediate",
                                                                       "middle_distal",
                                                                       "middle_tip",
                                                                       "ring_metacarpal",
                                                                       "ring_proximal",
                                                                       "ring_intermediate",
                                                                       "ring_distal",
                                                                       "ring_tip",
                                                                       "little_metacarpal",
                                                                       "little_proximal",
                                                                       "little_intermediate",
                                                                       "little_distal",
                                                                       "little_tip"};

// Returns joint_count for the wrist, the root. Palm and metacarpals are the wrist's children.
constexpr std::size_t parent_of(std::size_t joint) {
    if (joint == wrist) return joint_count;
    const bool first = joint == palm || joint == thumb_metacarpal ||
                       (joint >= index_metacarpal && (joint - index_metacarpal) % 5 == 0);
    return first ? static_cast<std::size_t>(wrist) : joint - 1;
}

// Joints of a digit from metacarpal to tip: first … first + count − 1.
struct Digit {
    std::size_t first = 0, count = 0;
};
inline constexpr std::array<Digit, 5> digits{Digit{thumb_metacarpal, 4}, Digit{index_metacarpal, 5},
                                             Digit{middle_metacarpal, 5}, Digit{ring_metacarpal, 5},
                                             Digit{little_metacarpal, 5}};

// Half the breadth (mm) of the gloved digit at each of its joints, metacarpal to tip.
inline constexpr std::array<std::array<double, 5>, 5> half_breadths_mm{{{15.0, 13.0, 11.9, 9.6, 0.0},
                                                                        {12.5, 11.8, 10.5, 9.7, 8.4},
                                                                        {12.8, 12.0, 10.7, 9.9, 8.6},
                                                                        {12.3, 11.4, 10.1, 9.4, 8.2},
                                                                        {11.5, 10.3, 9.0, 8.4, 7.4}}};
inline constexpr double glove_mm = 1.6;  // thickness of the glove at the tip

inline constexpr double skeleton_length = 0.189;  // m, wrist to the middle finger's tip along the bones

struct Skeleton {
    std::array<Vec3, joint_count> position{};
    std::array<Quat, joint_count> rotation{};
};

// The right hand, relaxed and open; its thumb points to −X. mirrored() gives the left hand (plane x = 0).
Skeleton right_skeleton();
// The same hand flat: all angles 0.
Skeleton flat_right_skeleton();
Skeleton mirrored(const Skeleton& skeleton);

// Mirrored in the plane x = 0, as from a right hand to a left one.
inline Quat mirrored(const Quat& q) { return {q.w, q.x, -q.y, -q.z}; }
inline Pose mirrored(const Pose& pose) {
    return {pose.position * Vec3(-1.0, 1.0, 1.0), mirrored(pose.orientation)};
}

// Forward kinematics: joint angles to the 26 joints of XR_EXT_hand_tracking.
//
// A finger's MCP has two axes, abduction in the palm's plane and then flexion; its other joints have one. The
// thumb's metacarpal rolls about the length of the hand and is abducted in the resulting plane; its other
// joints flex. The palm arch flexes the metacarpals of little and ring finger in the ratio 27 : 20
// (El-shennawy et al., see above).

// A person's hand.
struct Hand {
    Side side = Side::right;
    double scale = 1.0;  // this hand's lengths relative to `flat`
    Skeleton flat;       // of a right hand, in the frame of the wrist
};

// `length` (m): from the wrist to the tip of the middle finger.
Hand make_hand(Side side, double length = skeleton_length);

// All joints, in the frame in which `wrist` is given. Angles are not clamped; the wrist's own angles are
// ignored.
Skeleton joints(const Hand& hand, const Angles& angles, const Pose& wrist);

// Computes the joints of one digit only (0: thumb) and leaves the rest of `out` unchanged.
void place_digit(const Hand& hand, const Angles& angles, const Pose& wrist, std::size_t digit, Skeleton& out);

// The wrist pose from the forearm's; both frames coincide while the wrist is straight.
Pose wrist_of(const Hand& hand, const Angles& angles, const Pose& forearm);

inline constexpr std::size_t digit_count = 5;  // thumb, index … little finger

// The collision shape of one bone: a tapered capsule.
struct Capsule {
    Vec3 from{0.0}, to{0.0};                    // m
    double radius_from = 0.0, radius_to = 0.0;  // m, gloved
};
// The capsule of bone `bone` of a digit; 0 is the metacarpal.
Capsule bone_capsule(const Hand& hand, const Skeleton& joints, std::size_t digit, std::size_t bone);

// The centre of the fingertip pad, modelled as a sphere of radius pad_radius inside the finger that touches
// its surface.
inline constexpr double pad_radius = 8e-3;  // m, for a hand of scale 1
Vec3 fingertip_pad_centre(const Hand& hand, const Skeleton& joints, std::size_t digit);

}  // namespace bolt::hand
