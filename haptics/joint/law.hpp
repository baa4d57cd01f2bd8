// The laws of a joint: how the torque on its nut and its clamp force follow from the angle of the nut. A
// group of joints (group.hpp) has one of them. CONTRIBUTING.md lists the places that a new law touches.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "engine/base/enum_names.hpp"

namespace bolt::joint {

enum class Law : std::uint8_t {
    published,    // published.hpp: the four-stage law of the 2018 paper
    mechanistic,  // mechanistic.hpp: our law, with a continuous state for each joint
};
inline constexpr EnumNames<Law, 2> law_names{{"published", "mechanistic"}};

// The name in assembly, settings and session files and in the option --law.
constexpr std::string_view name(Law law) { return law_names.of(law); }
// None if no law has this name.
constexpr std::optional<Law> law_named(std::string_view text) { return law_names.find(text); }

}  // namespace bolt::joint
