#include "tools/author/import/colour.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bolt::step_import {

namespace {

int byte(double value) { return static_cast<int>(std::lround(std::clamp(value, 0.0, 1.0) * 255.0)); }

float to_linear(double s) {
    s = std::clamp(s, 0.0, 1.0);
    return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

}  // namespace

std::string hex(const Colour& colour) {
    return fmt::format("#{:02X}{:02X}{:02X}", byte(colour.r), byte(colour.g), byte(colour.b));
}

std::optional<Colour> parse_hex(std::string_view text) {
    if (text.size() != 7 || text[0] != '#') return std::nullopt;
    unsigned value = 0;
    const auto [end, problem] = std::from_chars(text.data() + 1, text.data() + text.size(), value, 16);
    if (problem != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    const auto part = [value](unsigned shift) {
        return static_cast<double>((value >> shift) & 0xFFU) / 255.0;
    };
    return Colour{part(16), part(8), part(0)};
}

glm::vec3 linear(const Colour& colour) {
    return {to_linear(colour.r), to_linear(colour.g), to_linear(colour.b)};
}

double saturation(const Colour& colour) {
    const double most = std::max({colour.r, colour.g, colour.b});
    const double least = std::min({colour.r, colour.g, colour.b});
    return most > 0.0 ? (most - least) / most : 0.0;
}

}  // namespace bolt::step_import
