// The laws of a joint: how the torque on its nut and its clamp force follow from the angle of the nut. A
// group of joints (group.hpp) has one of them. CONTRIBUTING.md lists the places that a new law touches.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace bolt::joint {

enum class Law : std::uint8_t {
    published,    // published.hpp: the four-stage law of the 2018 paper
    mechanistic,  // mechanistic.hpp: our law, with a continuous state for each joint
};
inline constexpr std::array all_laws{Law::published, Law::mechanistic};

// The name in assembly, settings and session files and in the option --law.
constexpr std::string_view name(Law law) {
    constexpr std::array<std::string_view, all_laws.size()> names{"published", "mechanistic"};
    return names.at(static_cast<std::size_t>(law));
}

// None if no law has this name.
constexpr std::optional<Law> law_named(std::string_view text) {
    for (const Law law : all_laws)
        if (name(law) == text) return law;
    return std::nullopt;
}

}  // namespace bolt::joint
