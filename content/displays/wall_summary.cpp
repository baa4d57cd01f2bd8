#include "content/displays/wall_summary.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "content/displays/wall_geometry.hpp"
#include "content/format/json_document.hpp"

namespace bolt::content {

namespace {

// The angle that the points are apart, seen from `eye`.
double angle_between(const Vec3& eye, const Vec3& a, const Vec3& b) {
    const Vec3 one = a - eye, other = b - eye;
    return std::atan2(glm::length(glm::cross(one, other)), glm::dot(one, other));
}

std::string describe_place(const DisplayOutput& output) {
    std::string text;
    if (output.position && output.resolution)
        text = fmt::format("{}x{}+{}+{}", output.resolution->width, output.resolution->height,
                           output.position->x, output.position->y);
    else if (output.monitor_index)
        text = fmt::format("monitor {}", *output.monitor_index);
    else
        text = "monitor " + output.monitor;
    if (!output.display.empty()) text += " on " + output.display;
    if (output.process != 0) text += fmt::format(" of process {}", output.process);
    return text;
}

std::string describe_head(const DisplayFile& displays) {
    const HeadTracking& head = displays.head;
    std::string text = "head: ";
    switch (head.tracker) {
        case HeadTracker::fixed:
            text += "fixed";
            break;
        case HeadTracker::dtrack:
            text += fmt::format("DTrack on UDP port {}, body {}", head.port, head.body);
            break;
        case HeadTracker::openxr:
            text += fmt::format("OpenXR, {}", name(head.pose));
            break;
        case HeadTracker::file:
            text += "recorded in " + in_quotes(head.recording);
            break;
    }
    const Vec3& at = head.fixed_head.position;
    text += fmt::format("; fixed head at {:.2f}, {:.2f}, {:.2f} m; eyes {:.0f} mm apart", at.x, at.y, at.z,
                        displays.eye_separation / mm);
    const Vec3& eyes = head.head_in_body.position;
    if (head.tracker != HeadTracker::fixed)
        text += fmt::format("; the point between them is at {:.0f}, {:.0f}, {:.0f} mm in the tracked body",
                            eyes.x / mm, eyes.y / mm, eyes.z / mm);
    return text + "\n";
}

std::string describe_wall(const Wall& wall, const WallSummary& s) {
    std::string picture = "unknown", pixel = "unknown";
    if (s.resolution) {
        picture = fmt::format("{}x{}", s.resolution->width, s.resolution->height);
        pixel = fmt::format("{:.2f}x{:.2f}", s.pixel_width / mm, s.pixel_height / mm);
    }
    std::string output = describe_place(wall.output);
    if (wall.right_output) output += ", " + describe_place(*wall.right_output);
    if (wall.swap_eyes) output += ", eyes swapped";
    return fmt::format("{:<12} {:>13} {:>6.1f} {:>6.1f} {:>10.2f} {:>9} {:<12} {:>10} {:>10}  {}\n",
                       wall.name, fmt::format("{:.3f}x{:.3f}", s.width, s.height), to_degrees(s.turn),
                       to_degrees(s.tilt), s.distance,
                       fmt::format("{:.0f}x{:.0f}", to_degrees(s.seen_width), to_degrees(s.seen_height)),
                       name(wall.stereo), picture, pixel, output);
}

std::string describe_seams(const DisplayFile& displays) {
    std::string text;
    for (std::size_t i = 0; i < displays.walls.size(); ++i)
        for (std::size_t j = i + 1; j < displays.walls.size(); ++j) {
            const WallAxes a = axes_of(displays.walls[i]), b = axes_of(displays.walls[j]);
            const auto gap = seam_gap(a, b);
            if (!gap || *gap > max_seam_gap) continue;
            const double between = pi - std::acos(std::clamp(glm::dot(a.normal, b.normal), -1.0, 1.0));
            text += fmt::format("{} and {} meet at {:.1f} degrees, gap {:.1f} mm\n", displays.walls[i].name,
                                displays.walls[j].name, to_degrees(between), *gap / mm);
        }
    return text;
}

}  // namespace

WallSummary summarize(const Wall& wall, const Vec3& fixed_head, const std::optional<PixelSize>& resolution) {
    const WallAxes axes = axes_of(wall);
    WallSummary s;
    s.width = axes.width;
    s.height = axes.height;
    const Vec3& normal = axes.normal;
    const double level = std::hypot(normal.x, normal.z);
    s.turn = level > 1e-3 ? std::atan2(normal.x, normal.z) : 0.0;
    s.tilt = std::atan2(normal.y, level) + 0.0;  // no negative zero
    s.distance = distance_in_front(axes, fixed_head);
    const Vec3 across = 0.5 * axes.width * axes.right, upwards = 0.5 * axes.height * axes.up;
    const Vec3 center = axes.origin + across + upwards;
    s.seen_width = angle_between(fixed_head, center - across, center + across);
    s.seen_height = angle_between(fixed_head, center - upwards, center + upwards);
    if (!resolution) return s;
    s.resolution = resolution;
    if (wall.stereo == StereoMode::side_by_side) s.resolution->width /= 2;
    if (wall.stereo == StereoMode::top_bottom) s.resolution->height /= 2;
    s.pixel_width = axes.width / s.resolution->width;
    s.pixel_height = axes.height / s.resolution->height;
    return s;
}

std::string list_walls(const DisplayFile& displays, const DisplayHost& host) {
    std::string text = displays.name.empty() ? "" : displays.name + "\n";
    text += describe_head(displays);
    text +=
        fmt::format("{:<12} {:>13} {:>6} {:>6} {:>10} {:>9} {:<12} {:>10} {:>10}  {}\n", "wall", "size, m",
                    "turn", "tilt", "distance,m", "seen, deg", "stereo", "picture,px", "pixel, mm", "output");
    for (const Wall& wall : displays.walls) {
        std::optional<PixelSize> resolution = wall.output.resolution;
        const bool is_here =
            wall.output.process == host.process &&
            (wall.output.display.empty() || is_same_display(wall.output.display, host.display));
        if (const HostMonitor* monitor = is_here ? find_monitor(wall.output, host.monitors) : nullptr)
            resolution = PixelSize{monitor->width, monitor->height};
        text += describe_wall(wall, summarize(wall, displays.head.fixed_head.position, resolution));
    }
    return text + describe_seams(displays);
}

}  // namespace bolt::content
