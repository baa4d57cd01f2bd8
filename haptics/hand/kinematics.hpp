// Forward kinematics: joint angles to the 26 joints of XR_EXT_hand_tracking.
//
// A finger's MCP has two axes, abduction in the palm's plane and then flexion; its other joints have one. The
// thumb's metacarpal rolls about the length of the hand and is abducted in the resulting plane; its other
// joints flex. The palm arch flexes the metacarpals of little and ring finger in the ratio 27 : 20
// (El-shennawy et al., see limits.hpp).
#pragma once

#include "engine/base/pose.hpp"
#include "haptics/hand/angles.hpp"
#include "haptics/hand/skeleton.hpp"

namespace bolt::hand {

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
Capsule tube(const Hand& hand, const Skeleton& joints, std::size_t digit, std::size_t bone);

// The centre of the fingertip pad, modelled as a sphere of radius pad_radius that touches the skin.
inline constexpr double pad_radius = 8e-3;  // m, for a hand of scale 1
Vec3 pad(const Hand& hand, const Skeleton& joints, std::size_t digit);

}  // namespace bolt::hand
