// The stage of a joint that the hand feels, and the joint's condition. All laws (law.hpp) use these names.
#pragma once

#include <cstdint>
#include <string_view>

#include "engine/base/enum_names.hpp"

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

inline constexpr EnumNames<Stage, 4> stage_names{{"navigation", "transition", "linearity", "yield"}};
constexpr std::string_view name(Stage stage) { return stage_names.of(stage); }

// The names in session files. They store `intact` as "sound", for compatibility.
inline constexpr EnumNames<JointCondition, 3> joint_condition_names{{"sound", "stripped", "broken"}};
constexpr std::string_view name(JointCondition condition) { return joint_condition_names.of(condition); }

}  // namespace bolt::joint
