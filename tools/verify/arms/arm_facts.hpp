// The arms that Boltwright drives, as the validation emulates them: their drivers' descriptions, and
// published figures of their mechanics.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "haptics/device/device.hpp"
#include "haptics/device/simulated_arm.hpp"

namespace bolt::arm_validation {

// The reliability of a figure.
enum class Origin : std::uint8_t {
    published,   // read at the source that is named
    unverified,  // attributed to the maker's data sheet, which could not be read again for this table
    assumed,     // no figure was found: a value of ours on the side that makes instability more likely
};

struct Fact {
    double value = 0.0;
    Origin origin = Origin::assumed;
    std::string_view source{};  // empty if assumed
};

// SI units. The inertia and the resolution of the rotation matter only for arms that sense rotations.
struct ArmFacts {
    std::string_view key;                          // for the command line
    std::string_view name;                         // for the tables
    device::Description (*announced)() = nullptr;  // the description that the driver announces
    bool senses_rotation = true;
    Fact mass;             // kg, apparent at the handle
    Fact friction;         // N, dry
    Fact encoder;          // m, one step at the handle
    Fact inertia;          // kg·m², of the wrist about the handle
    Fact angular_encoder;  // rad
};

std::span<const ArmFacts> arm_table();
const ArmFacts* find_arm(std::string_view key);  // null: none

// The hand that holds the arm: mass, damper and spring to its intended pose (Hogan, as in simulated_arm.hpp).
// The masses of hand and arm add up.
struct NamedHandImpedance {
    std::string_view name;
    double mass = 0.0, damping = 0.0, stiffness = 0.0;                     // kg, N·s/m, N/m
    double inertia = 0.0, angular_damping = 0.0, angular_stiffness = 0.0;  // kg·m², N·m·s/rad, N·m/rad
    bool unheld = false;  // nobody holds the arm; a very soft spring stands for a constant push
};

inline constexpr std::size_t hand_impedance_count = 4;
// No hand, and a loose, a usual and a stiff hand. The first one is the worst case: only the arm's own
// friction damps it.
const std::array<NamedHandImpedance, hand_impedance_count>& hand_impedances();
inline constexpr std::size_t loose_hand = 1, usual_hand = 2;

device::HandAndArmParameters parameters_of(const ArmFacts& arm, const NamedHandImpedance& hand);

}  // namespace bolt::arm_validation
