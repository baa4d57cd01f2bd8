#include "content/displays/pvx_values.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace bolt::content {

std::vector<std::string_view> split(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    std::size_t start = 0;
    for (std::size_t i = 0; i <= text.size(); ++i) {
        if (i < text.size() && !is_blank(text[i]) && text[i] != separator) continue;
        if (i > start) parts.push_back(text.substr(start, i - start));
        start = i + 1;
    }
    return parts;
}

std::optional<double> finite_number(std::string_view text) {
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return std::nullopt;
    return value;
}

std::optional<bool> parse_bool(std::string_view text) {
    for (const std::string_view yes : {"1", "true", "True", "yes", "on"})
        if (text == yes) return true;
    for (const std::string_view no : {"0", "false", "False", "no", "off"})
        if (text == no) return false;
    return std::nullopt;
}

std::optional<std::pair<PixelPosition, PixelSize>> parse_geometry(std::string_view text) {
    int values[4] = {};
    constexpr char separators[] = {'x', '+', '+', '\0'};
    const char *at = text.data(), *const end = text.data() + text.size();
    for (std::size_t i = 0; i < 4; ++i) {
        const auto [next, problem] = std::from_chars(at, end, values[i]);
        const bool is_last = i == 3;
        if (problem != std::errc() || (is_last ? next != end : next == end || *next != separators[i]))
            return std::nullopt;
        at = is_last ? next : next + 1;
    }
    const auto [width, height, x, y] = values;
    const auto fits = [](int size) { return size >= 16 && size <= 32768; };
    if (!fits(width) || !fits(height) || std::max(std::abs(x), std::abs(y)) > 100000) return std::nullopt;
    return std::pair(PixelPosition{x, y}, PixelSize{width, height});
}

}  // namespace bolt::content
