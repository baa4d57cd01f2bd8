// Values of attributes in ParaView's .pvx files.
#pragma once

#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "content/displays/display_file.hpp"

namespace bolt::content {

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// The parts of the text between blanks and separators, without empty parts.
std::vector<std::string_view> split(std::string_view text, char separator);

// None if the whole text is not a finite number.
std::optional<double> finite_number(std::string_view text);

// "1", "true", "0", "false", ...
std::optional<bool> parse_bool(std::string_view text);

// "1920x1080+0+-20"; none if it has another form, or a size that no window has.
std::optional<std::pair<PixelPosition, PixelSize>> parse_geometry(std::string_view text);

}  // namespace bolt::content
