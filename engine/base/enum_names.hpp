// The names of the values of an enumeration, as files and options write them:
//
//     enum class HeadShape : std::uint8_t { hexagon, socket };
//     inline constexpr EnumNames<HeadShape, 2> head_shape_names{{"hexagon", "socket"}};
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace bolt {

// The values of E count from 0 without gaps; `names` is in their order.
template <class E, std::size_t count>
struct EnumNames {
    std::array<std::string_view, count> names;

    [[nodiscard]] constexpr std::string_view of(E value) const {
        return names.at(static_cast<std::size_t>(value));
    }
    // None if no value has this name.
    [[nodiscard]] constexpr std::optional<E> find(std::string_view name) const {
        const auto* const found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) return std::nullopt;
        return static_cast<E>(found - names.begin());
    }
};

}  // namespace bolt
