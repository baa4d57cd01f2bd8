// A CAD colour: sRGB as the file and its author write it.
#pragma once

#include <glm/vec3.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace bolt::step_import {

struct Colour {
    double r = 0.0, g = 0.0, b = 0.0, alpha = 1.0;
    friend bool operator==(const Colour&, const Colour&) = default;
};

// "#2F5D62", and the other way. Alpha is not part of it.
std::string hex(const Colour& colour);
std::optional<Colour> parse_hex(std::string_view text);

// IEC 61966-2-1.
glm::vec3 linear(const Colour& colour);

// Largest less smallest component over the largest; 0: grey.
double saturation(const Colour& colour);

}  // namespace bolt::step_import
