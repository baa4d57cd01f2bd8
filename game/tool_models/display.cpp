#include "game/tool_models/display.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace bolt::tool_models {

namespace {

constexpr int digit_count = 4;
constexpr std::string_view segment_prefix = "segment_", point_name = "decimal_point", reached_name = "light",
                           exceeded_name = "light_exceeded";

// Bit i: segment i of DisplayElement.
constexpr std::array<std::uint8_t, 10> segments_of_digit = {0b0111111, 0b0000110, 0b1011011, 0b1001111,
                                                            0b1100110, 0b1101101, 0b1111101, 0b0000111,
                                                            0b1111111, 0b1101111};

// The middle of a segment, in a box of width 0.6 and height 1 around the origin.
struct SegmentPlace {
    double x, y;
    bool upright;
};
constexpr std::array<SegmentPlace, 7> segment_places = {{{0.0, 0.43, false},
                                                         {0.23, 0.215, true},
                                                         {0.23, -0.215, true},
                                                         {0.0, -0.43, false},
                                                         {-0.23, -0.215, true},
                                                         {-0.23, 0.215, true},
                                                         {0.0, 0.0, false}}};

Shell bar(double x, double y, double half_wide, double half_high, double z) {
    const double round = 0.8 * std::min(half_wide, half_high);
    return block({x - half_wide, y - half_high, z - 0.2}, {x + half_wide, y + half_high, z + 0.15}, round,
                 0.05, 1);
}

}  // namespace

std::optional<DisplayElement> display_element(std::string_view node) {
    using Kind = DisplayElement::Kind;
    if (node == point_name) return DisplayElement{Kind::point};
    if (node == reached_name) return DisplayElement{Kind::reached};
    if (node == exceeded_name) return DisplayElement{Kind::exceeded};
    if (!node.starts_with(segment_prefix) || node.size() != segment_prefix.size() + 3 ||
        node[segment_prefix.size() + 1] != '_')
        return std::nullopt;
    const int digit = node[segment_prefix.size()] - '0', segment = node[segment_prefix.size() + 2] - '0';
    if (digit < 0 || digit >= digit_count || segment < 0 || segment >= 7) return std::nullopt;
    return DisplayElement{Kind::segment, digit, segment};
}

bool is_on(const DisplayElement& element, const DisplayReading& reading) {
    switch (element.kind) {
        case DisplayElement::Kind::point:
            return true;
        case DisplayElement::Kind::reached:
            return reading.reached;
        case DisplayElement::Kind::exceeded:
            return reading.exceeded;
        case DisplayElement::Kind::segment:
            break;
    }
    constexpr std::array<int, digit_count> places = {1000, 100, 10, 1};  // of tenths
    const int tenths = static_cast<int>(std::lround(10.0 * std::clamp(std::abs(reading.value), 0.0, 999.9)));
    const int place = places[static_cast<std::size_t>(element.digit)];
    if (place > 10 && tenths < place) return false;
    const auto digit = static_cast<std::size_t>(tenths / place % 10);
    const unsigned segments = segments_of_digit[digit];
    return (segments >> static_cast<unsigned>(element.segment) & 1U) != 0;
}

ToolModelParts number_parts(double from, double to, double z) {
    constexpr double pitch = 0.85;  // between digits, in heights of a digit
    const double height = std::min(13.0, 0.28 * (to - from)), half = 0.055 * height;
    const auto middle_of = [&](double digit) {
        return 0.5 * (from + to) + (digit - 0.5 * (digit_count - 1)) * pitch * height;
    };
    ToolModelParts parts;
    for (int digit = 0; digit < digit_count; ++digit)
        for (std::size_t i = 0; i < segment_places.size(); ++i) {
            const SegmentPlace& at = segment_places[i];
            const double along = (at.upright ? 0.16 : 0.17) * height;
            parts.push_back({fmt::format("{}{}_{}", segment_prefix, digit, i),
                             Finish::light,
                             {bar(middle_of(digit) + at.x * height, at.y * height, at.upright ? half : along,
                                  at.upright ? along : half, z)}});
        }
    parts.push_back({std::string(point_name),
                     Finish::light,
                     {bar(middle_of(digit_count - 1.5), -0.45 * height, half, half, z)}});
    return parts;
}

ToolModelParts light_parts(double x, Detail detail) {
    const auto ring = [&](double begin, double end) {
        return lathe_x(
            std::vector<ProfilePoint>{{begin, 13.2}, {begin + 0.5, 14.4}, {end - 0.3, 14.4}, {end, 13.6}},
            detail == Detail::drawn ? 64 : 24);
    };
    return {{std::string(reached_name), Finish::light, {ring(x - 5.0, x - 1.2)}},
            {std::string(exceeded_name), Finish::alarm, {ring(x - 8.8, x - 5.0)}}};
}

}  // namespace bolt::tool_models
