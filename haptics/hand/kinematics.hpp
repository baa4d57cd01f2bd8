// From the angles of a hand to the 26 joints of XR_EXT_hand_tracking.
//
// A finger's knuckle turns about two axes, to the side in the palm's plane and then in flexion, its other
// joints about one. The thumb's metacarpal rolls about the hand's length and is abducted in the plane that it
// has rolled to; its other joints bend. Hollowing the palm bends the metacarpals of little and ring finger,
// by ranges that are as 27 to 20 (El-shennawy et al., see limits.hpp).
#pragma once

#include "engine/base/pose.hpp"
#include "haptics/hand/angles.hpp"
#include "haptics/hand/skeleton.hpp"

namespace bolt::hand {

enum class Side : std::uint8_t { left, right };

// A person's hand.
struct Hand {
    Side side = Side::right;
    double scale = 1.0;  // of `flat`'s lengths to this hand's
    Skeleton flat;       // of a right hand, in the frame of the wrist
};

// `length` (m): of the hand, from the wrist to the tip of the middle finger.
Hand make_hand(Side side, double length = skeleton_length);

// The joints where the wrist's are given. Angles as they come, not limited; those of the wrist do not matter.
Skeleton joints(const Hand& hand, const Angles& angles, const Pose& wrist);

// Of these only one digit's, 0 the thumb: what else is in `out` stays.
void place_digit(const Hand& hand, const Angles& angles, const Pose& wrist, std::size_t digit, Skeleton& out);

// The wrist, of a forearm whose frame is the wrist's while that is straight: bent by a glove's sensors.
Pose wrist_of(const Hand& hand, const Angles& angles, const Pose& forearm);

inline constexpr std::size_t digit_count = 5;  // thumb, index … little finger

// A part of a digit that touches things: a tube about the bone, its ends round.
struct Tube {
    Vec3 from{0.0}, to{0.0};                    // m
    double radius_from = 0.0, radius_to = 0.0;  // m, gloved
};
// Of bone k of a digit, 0 that of the metacarpal joint.
Tube tube(const Hand& hand, const Skeleton& joints, std::size_t digit, std::size_t bone);

// The middle of the fingertip's pad as a ball that touches the pad's skin.
inline constexpr double pad_radius = 8e-3;  // m, of a hand of scale 1
Vec3 pad(const Hand& hand, const Skeleton& joints, std::size_t digit);

}  // namespace bolt::hand
