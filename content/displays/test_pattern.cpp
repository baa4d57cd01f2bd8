#include "content/displays/test_pattern.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "content/displays/wall_geometry.hpp"

namespace bolt::content {

namespace {

using glm::dvec2;

void add_line(TestPattern& pattern, PatternPart part, const dvec2& from, const dvec2& to) {
    pattern.lines.push_back({part, from, to});
}

void add_cross(TestPattern& pattern, const dvec2& center, double arm) {
    add_line(pattern, PatternPart::cross, center - dvec2(arm, 0.0), center + dvec2(arm, 0.0));
    add_line(pattern, PatternPart::cross, center - dvec2(0.0, arm), center + dvec2(0.0, arm));
}

// A line of `scale_length` with a mark across each end.
void add_scale(TestPattern& pattern, const dvec2& from, const dvec2& direction, double mark) {
    const dvec2 to = from + pattern.scale_length * direction,
                across = mark * dvec2(-direction.y, direction.x);
    add_line(pattern, PatternPart::scale, from, to);
    for (const dvec2& end : {from, to}) add_line(pattern, PatternPart::scale, end - across, end + across);
}

// The number of the frame, and upright marks in a row to the right of it.
void add_frame(TestPattern& pattern, std::uint64_t frame, const dvec2& left, double text_height) {
    const double spacing = 0.6 * text_height, half = 0.4 * text_height;
    pattern.texts.push_back(
        {fmt::format("frame {}", frame), left + dvec2(3.0 * text_height, 0.0), text_height});
    const auto present = static_cast<int>(frame % std::uint64_t{frame_mark_count});
    for (int i = 0; i < frame_mark_count; ++i) {
        const dvec2 at = left + dvec2(6.5 * text_height + i * spacing, 0.0);
        const bool is_present = i == present;
        const dvec2 arm(0.0, is_present ? 2.0 * half : half);
        add_line(pattern, is_present ? PatternPart::present_mark : PatternPart::frame_marks, at - arm,
                 at + arm);
    }
}

double longest_scale(double edge) {
    constexpr double lengths[] = {1.0, 0.5, 0.2, 0.1, 0.05, 0.02};
    const auto* const it = std::find_if(std::begin(lengths), std::end(lengths),
                                        [&](double length) { return length <= 0.4 * edge; });
    return it == std::end(lengths) ? 0.4 * edge : *it;
}

}  // namespace

TestPattern test_pattern(const Wall& wall, PatternEye eye, std::uint64_t frame) {
    TestPattern pattern;
    const double across = width(wall), upwards = height(wall), edge = std::min(across, upwards);
    if (!(edge > 0.0)) return pattern;
    const dvec2 lower_left(0.0), lower_right(across, 0.0), upper_right(across, upwards),
        upper_left(0.0, upwards);
    const dvec2 corners[] = {lower_left, lower_right, upper_right, upper_left};
    for (std::size_t i = 0; i < 4; ++i)
        add_line(pattern, PatternPart::border, corners[i], corners[(i + 1) % 4]);
    add_line(pattern, PatternPart::diagonal, lower_left, upper_right);
    add_line(pattern, PatternPart::diagonal, lower_right, upper_left);
    const dvec2 center = 0.5 * upper_right, inset(0.1 * edge);
    add_cross(pattern, center, 0.1 * edge);
    for (const dvec2& corner : corners)
        add_cross(pattern, glm::clamp(corner, inset, upper_right - inset), 0.05 * edge);
    pattern.scale_length = longest_scale(edge);
    const double half = 0.5 * pattern.scale_length;
    add_scale(pattern, {center.x - half, 0.2 * upwards}, {1.0, 0.0}, 0.02 * edge);
    add_scale(pattern, {0.15 * across, center.y - half}, {0.0, 1.0}, 0.02 * edge);

    const double text_height = 0.06 * edge;
    pattern.texts.push_back({wall.name, {center.x, 0.8 * upwards}, text_height});
    pattern.texts.push_back(
        {fmt::format("{:g} m", pattern.scale_length), {center.x, 0.2 * upwards - text_height}, text_height});
    // 12 text heights wide.
    add_frame(pattern, frame, {center.x - 6.0 * text_height, 0.68 * upwards}, text_height);
    if (eye == PatternEye::left) pattern.texts.push_back({"left", {0.3 * across, center.y}, text_height});
    if (eye == PatternEye::right) pattern.texts.push_back({"right", {0.7 * across, center.y}, text_height});
    return pattern;
}

Vec3 pattern_point(const Wall& wall, const glm::dvec2& point) {
    return in_room(axes_of(wall), point.x, point.y);
}

}  // namespace bolt::content
