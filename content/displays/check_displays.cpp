#include "content/displays/check_displays.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "content/displays/panel_fit.hpp"
#include "content/displays/wall_geometry.hpp"
#include "content/format/json_document.hpp"

namespace bolt::content {

namespace {

using DisplayFindings = std::vector<DisplayFinding>;

std::string in_m(const Vec3& point) {
    return fmt::format("({:.3g}, {:.3g}, {:.3g}) m", point.x, point.y, point.z);
}

void check_names(const DisplayFile& displays, DisplayFindings& findings) {
    for (std::size_t i = 0; i < displays.walls.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            if (displays.walls[i].name == displays.walls[j].name)
                findings.push_back(
                    {true,
                     fmt::format("walls {} and {} are both named {}; expected a name of its own", j + 1,
                                 i + 1, in_quotes(displays.walls[i].name)),
                     i});
}

void check_eyes(const DisplayFile& displays, DisplayFindings& findings) {
    const double separation = displays.eye_separation;
    const bool stereo = std::any_of(displays.walls.begin(), displays.walls.end(),
                                    [](const Wall& wall) { return wall.stereo != StereoMode::mono; });
    if (!(separation >= 0.0 && separation <= max_eye_separation))
        findings.push_back({true, fmt::format("the eye separation is {:g} m; expected 0 to {:g} m",
                                              separation, max_eye_separation)});
    else if (stereo && (separation < narrow_eyes || separation > wide_eyes))
        findings.push_back(
            {false, fmt::format("the eye separation is {:g} m; expected {:g} to {:g} m, the distance "
                                "between the pupils of the viewer",
                                separation, narrow_eyes, wide_eyes)});
}

// Returns true if the corners make a rectangle of plausible size, so that other checks make sense.
bool check_shape(const Wall& wall, DisplayFindings& findings) {
    const std::string label = "wall " + in_quotes(wall.name);
    const double across = width(wall), upwards = height(wall);
    if (!(across >= min_wall_edge && upwards >= min_wall_edge)) {
        findings.push_back(
            {true, fmt::format("{}: it is {:.3g} m wide and {:.3g} m high; expected at least {:g} m "
                               "each: are two corners the same?",
                               label, across, upwards, min_wall_edge)});
        return false;
    }
    if (std::max(across, upwards) > max_wall_edge)
        findings.push_back(
            {false, fmt::format("{}: it is {:.3g} m wide and {:.3g} m high; expected at most {:g} m: "
                                "are its corners in metres?",
                                label, across, upwards, max_wall_edge)});
    const double cosine = glm::dot(wall.lower_left - wall.lower_right, wall.upper_right - wall.lower_right) /
                          (across * upwards);
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0));
    if (std::abs(angle - pi / 2) <= right_angle_tolerance) return true;
    findings.push_back(
        {true, fmt::format("{}: its angle at the lower right corner is {:.2f} degrees; expected 90 "
                           "to {:g}",
                           label, to_degrees(angle), to_degrees(right_angle_tolerance))});
    return false;
}

void check_viewer(const DisplayFile& displays, const Wall& wall, DisplayFindings& findings) {
    const WallAxes axes = axes_of(wall);
    const Vec3& eye = displays.head.fixed_head.position;
    const double distance = distance_in_front(axes, eye);
    const std::string label = "wall " + in_quotes(wall.name);
    if (distance < 0.0)
        findings.push_back(
            {true, fmt::format("{}: the fixed head {} is {:.3g} m behind it; expected it in front: are "
                               "its left and right corners exchanged?",
                               label, in_m(eye), -distance)});
    else if (distance < min_viewer_distance)
        findings.push_back(
            {true, fmt::format("{}: the fixed head {} is {:.3g} m in front of it; expected at least "
                               "{:g} m",
                               label, in_m(eye), distance, min_viewer_distance)});
    if (distance > 0.0 && axes.up.y < -0.5)
        findings.push_back(
            {false, fmt::format("{}: its upper corner is below its lower corners: its picture stands "
                                "on its head",
                                label)});
}

void check_pair(const Wall& wall, const Wall& other, DisplayFindings& findings) {
    const WallAxes a = axes_of(wall), b = axes_of(other);
    const std::string label = fmt::format("walls {} and {}", in_quotes(wall.name), in_quotes(other.name));
    if (walls_cross(a, b, wall_tolerance)) {
        findings.push_back({true, label + " cross; expected walls that meet at their edges"});
        return;
    }
    const auto a_in_b = edge_inset(a, b, wall_tolerance), b_in_a = edge_inset(b, a, wall_tolerance);
    if (a_in_b || b_in_a) {
        const Wall &ends = a_in_b ? wall : other, &hidden = a_in_b ? other : wall;
        findings.push_back(
            {false,
             fmt::format("wall {} ends {:.0f} mm inside wall {}: what is behind it cannot "
                         "be seen",
                         in_quotes(ends.name), (a_in_b ? *a_in_b : *b_in_a) / mm, in_quotes(hidden.name))});
        return;
    }
    if (const auto overlap = coplanar_overlap(a, b, wall_tolerance)) {
        findings.push_back({false, fmt::format("{} overlap by {:.1f} mm: their pictures are not blended",
                                               label, *overlap / mm)});
        return;
    }
    const auto gap = seam_gap(a, b);
    if (gap && *gap > seam_tolerance && *gap < max_seam_gap)
        findings.push_back(
            {false, fmt::format("{} nearly meet: the gap is up to {:.1f} mm; expected the same edge, "
                                "unless something stands between them",
                                label, *gap / mm)});
}

}  // namespace

std::vector<DisplayFinding> check_walls(const DisplayFile& displays) {
    DisplayFindings findings;
    check_names(displays, findings);
    check_eyes(displays, findings);
    std::vector<std::size_t> shaped;
    const auto assign_wall = [&](std::size_t wall, std::size_t from) {
        for (std::size_t i = from; i < findings.size(); ++i) findings[i].wall = wall;
    };
    for (std::size_t i = 0; i < displays.walls.size(); ++i) {
        const std::size_t before = findings.size();
        if (check_shape(displays.walls[i], findings)) {
            check_viewer(displays, displays.walls[i], findings);
            shaped.push_back(i);
        }
        assign_wall(i, before);
    }
    for (std::size_t j = 0; j < shaped.size(); ++j)
        for (std::size_t i = 0; i < j; ++i) {
            const std::size_t before = findings.size();
            check_pair(displays.walls[shaped[i]], displays.walls[shaped[j]], findings);
            assign_wall(shaped[j], before);
        }
    return findings;
}

std::vector<DisplayFinding> check_viewing(const DisplayFile& displays) {
    constexpr double floor_tolerance = 0.05;  // m
    constexpr const char* hint = "is the origin at the viewer's eyes? (displays import --eye-height)";
    DisplayFindings findings;
    // Corners that are not in metres need one message only.
    if (std::any_of(displays.walls.begin(), displays.walls.end(),
                    [](const Wall& wall) { return std::max(width(wall), height(wall)) > max_wall_edge; }))
        return findings;
    const double eyes = displays.head.fixed_head.position.y;
    double highest = 0.0;
    bool upright = false;
    for (std::size_t i = 0; i < displays.walls.size(); ++i) {
        const WallAxes axes = axes_of(displays.walls[i]);
        double lowest = 0.0;
        for (const Vec3& corner : corners_of(axes)) {
            lowest = std::min(lowest, corner.y);
            highest = std::max(highest, corner.y);
        }
        upright = upright || axes.up.y > 0.5;
        if (lowest < -floor_tolerance)
            findings.push_back({false,
                                fmt::format("wall {}: its lowest corner is {:.2f} m below the floor, where y "
                                            "is 0; expected it on the floor or above: {}",
                                            in_quotes(displays.walls[i].name), -lowest, hint),
                                i});
    }
    if (upright && eyes > highest)
        findings.push_back({false, fmt::format("the fixed head, {:.2f} m high, is above all walls, which end "
                                               "at {:.2f} m; expected walls at the height of the eyes: {}",
                                               eyes, highest, hint)});
    const std::optional<PanelFit> panel = fit_panel(displays.walls, displays.head.fixed_head);
    if (panel && panel->text_size < 0.99 * comfortable_text)
        findings.push_back(
            {false,
             fmt::format("wall {}: the panel of menus and hints fits on it with text of {:.0f} dmm (mm at 1 "
                         "m); expected {:.0f} dmm: a larger wall, or a fixed head that is nearer",
                         in_quotes(displays.walls[panel->wall].name), panel->text_size, comfortable_text),
             panel->wall});
    return findings;
}

std::vector<DisplayFinding> check_displays(const DisplayFile& displays, const DisplayHost& host) {
    DisplayFindings findings = check_walls(displays);
    if (std::none_of(findings.begin(), findings.end(),
                     [](const DisplayFinding& finding) { return finding.prevents_use; }))
        for (DisplayFinding& finding : check_viewing(displays)) findings.push_back(std::move(finding));
    for (DisplayFinding& finding : check_outputs(displays, host)) findings.push_back(std::move(finding));
    std::stable_partition(findings.begin(), findings.end(),
                          [](const DisplayFinding& finding) { return finding.prevents_use; });
    return findings;
}

std::string describe(std::span<const DisplayFinding> findings, const LoadedDisplays& loaded) {
    std::string text;
    for (const DisplayFinding& finding : findings) {
        Error line;
        line.file = loaded.file;
        line.what = (finding.prevents_use ? "" : "warning: ") + finding.text;
        if (finding.wall && *finding.wall < loaded.wall_positions.size()) {
            line.line = loaded.wall_positions[*finding.wall].line;
            line.column = loaded.wall_positions[*finding.wall].column;
        }
        text += line.message() + "\n";
    }
    return text;
}

}  // namespace bolt::content
