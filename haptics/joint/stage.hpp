// The stage of a joint that the hand feels, and the joint's condition. All laws (law.hpp) use these names.
#pragma once

#include <cstdint>
#include <string_view>

namespace bolt::joint {

// The four stages of the 2018 paper, derived from the state of the joint:
//   navigation  the nut turns on its thread and does not press on its seat
//   transition  the nut reaches its seat: clamp force and torque begin to grow, and grow ever faster
//   linearity   clamp force and torque grow in proportion to the angle
//   yield       the bolt stretches permanently: the torque grows at most half as fast as in linearity, or
//               falls. A nut with a stripped thread is in this stage too.
enum class Stage : std::uint8_t { navigation, transition, linearity, yield };
inline constexpr int stage_count = 4;

enum class JointCondition : std::uint8_t { intact, stripped, broken };

constexpr std::string_view name(Stage stage) {
    constexpr std::string_view names[] = {"navigation", "transition", "linearity", "yield"};
    return names[static_cast<int>(stage)];
}

// The name in session files. They store `intact` as "sound", for compatibility.
constexpr std::string_view name(JointCondition condition) {
    constexpr std::string_view names[] = {"sound", "stripped", "broken"};
    return names[static_cast<int>(condition)];
}

}  // namespace bolt::joint
