// The 26 joints of XR_EXT_hand_tracking (OpenXR 1.0, section 12.31) of a relaxed and of a flat hand. Frames
// of the extension: −Z from the wrist towards the tip along the bone that begins at the joint, +Y out of the
// back of the hand or the nail, +X to the right. Positions in m, in the frame of the wrist joint.
//
// Lengths of bones and of the soft tissue at the tips are plausible and near A. Buryanov, V. Kotiuk,
// Proportions of hand segments, Int. J. Morphol. 28(3), 2010, 755-758; they are not verified against that
// table. With a carpus of 32 mm the hand is 189 mm long, about the median of men.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "engine/base/math.hpp"

namespace bolt::hand {

enum class Side : std::uint8_t { left, right };

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

// joint_count for the wrist, the root. Palm and metacarpals are its children.
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

}  // namespace bolt::hand
