#include <fmt/format.h>

#include <algorithm>

#include "content/displays/check_displays.hpp"
#include "content/format/json_document.hpp"

namespace bolt::content {

namespace {

using DisplayFindings = std::vector<DisplayFinding>;

struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
};

// An output of a wall; `rect` is where it is on the desktop, as far as that is known.
struct PlacedOutput {
    std::string label;  // for messages
    const Wall* wall = nullptr;
    std::size_t index = 0;  // of the wall
    const DisplayOutput* output = nullptr;
    std::string display;  // empty: that of the program, whose name is not known
    std::optional<PixelRect> rect;
    std::optional<PixelSize> size;
};

PixelRect common_part(const PixelRect& a, const PixelRect& b) {
    const int left = std::max(a.x, b.x), top = std::max(a.y, b.y);
    return {left, top, std::min(a.x + a.width, b.x + b.width) - left,
            std::min(a.y + a.height, b.y + b.height) - top};
}

bool has_pixels(const PixelRect& rect) { return rect.width > 0 && rect.height > 0; }

// Returns true if the monitors together cover every pixel of `rect`.
bool is_covered(const PixelRect& rect, std::span<const HostMonitor> monitors) {
    if (!has_pixels(rect)) return true;
    if (monitors.empty()) return false;
    const HostMonitor& m = monitors.front();
    const PixelRect common = common_part(rect, {m.x, m.y, m.width, m.height});
    const auto rest = monitors.subspan(1);
    if (!has_pixels(common)) return is_covered(rect, rest);
    const int right = common.x + common.width, bottom = common.y + common.height;
    // The parts above, below, to the left and to the right of the common part.
    return is_covered({rect.x, rect.y, rect.width, common.y - rect.y}, rest) &&
           is_covered({rect.x, bottom, rect.width, rect.y + rect.height - bottom}, rest) &&
           is_covered({rect.x, common.y, common.x - rect.x, common.height}, rest) &&
           is_covered({right, common.y, rect.x + rect.width - right, common.height}, rest);
}

std::vector<PlacedOutput> outputs_of(const DisplayFile& displays) {
    std::vector<PlacedOutput> all;
    const auto add = [&](const Wall& wall, const DisplayOutput& output, const char* eye) {
        PlacedOutput placed;
        placed.label = "wall " + in_quotes(wall.name) + eye;
        placed.wall = &wall;
        placed.index = static_cast<std::size_t>(&wall - displays.walls.data());
        placed.output = &output;
        placed.display = output.display;
        placed.size = output.resolution;
        if (output.position && output.resolution)
            placed.rect = {output.position->x, output.position->y, output.resolution->width,
                           output.resolution->height};
        all.push_back(std::move(placed));
    };
    for (const Wall& wall : displays.walls) {
        add(wall, wall.output, wall.right_output ? ", left output" : "");
        if (wall.right_output) add(wall, *wall.right_output, ", right output");
    }
    return all;
}

// ":0" is the X screen ":0.0".
std::string_view x_screen(std::string_view display) {
    if (display.ends_with(".0")) display.remove_suffix(2);
    return display;
}

std::string geometry(const PixelRect& rect) {
    return fmt::format("{}x{}+{}+{}", rect.width, rect.height, rect.x, rect.y);
}

std::string monitor_list(std::span<const HostMonitor> monitors) {
    std::string text;
    for (const HostMonitor& m : monitors)
        text +=
            fmt::format("{}{} {}", text.empty() ? "" : ", ", m.name, geometry({m.x, m.y, m.width, m.height}));
    return text;
}

// "did you mean "DP-1"?" or "expected one of DP-1, DP-2".
std::string suggestion(const std::string& name, std::span<const HostMonitor> monitors) {
    std::vector<std::string> names;
    for (const HostMonitor& monitor : monitors) names.push_back(monitor.name);
    const std::string text = suggest(name, names);
    return (text.starts_with("did you mean") ? "" : "expected ") + text;
}

void report(DisplayFindings& findings, bool prevents_use, const PlacedOutput& placed,
            const std::string& text) {
    findings.push_back({prevents_use, placed.label + ": " + text, placed.index});
}

// Finds the output's monitor, or reports why there is none.
void assign_monitor(PlacedOutput& placed, std::span<const HostMonitor> monitors, DisplayFindings& findings) {
    const DisplayOutput& output = *placed.output;
    if (placed.rect) {
        if (!is_covered(*placed.rect, monitors))
            report(findings, true, placed,
                   fmt::format("the window {} is not on the monitors; expected it within {}",
                               geometry(*placed.rect), monitor_list(monitors)));
        return;
    }
    const HostMonitor* found = find_monitor(output, monitors);
    if (found == nullptr && output.monitor_index)
        report(findings, true, placed,
               fmt::format("there is no monitor with the index {}; expected 0 to {}", *output.monitor_index,
                           monitors.size() - 1));
    else if (found == nullptr)
        report(findings, true, placed,
               fmt::format("there is no monitor {}; {}", in_quotes(output.monitor),
                           suggestion(output.monitor, monitors)));
    if (found == nullptr) return;
    placed.rect = {found->x, found->y, found->width, found->height};
    const PixelSize size{found->width, found->height};
    if (placed.size && *placed.size != size)
        report(findings, false, placed,
               fmt::format("the monitor {} has {}x{} pixels; expected {}x{}, as the file says",
                           in_quotes(found->name), size.width, size.height, placed.size->width,
                           placed.size->height));
    placed.size = size;
}

void check_pixels(const PlacedOutput& placed, DisplayFindings& findings) {
    if (!placed.size) return;
    const Wall& wall = *placed.wall;
    const auto [across, upwards] = *placed.size;
    const bool beside = wall.stereo == StereoMode::side_by_side,
               above = wall.stereo == StereoMode::top_bottom;
    if ((beside && across % 2 != 0) || (above && upwards % 2 != 0)) {
        report(findings, true, placed,
               fmt::format("{}x{} pixels cannot be halved for two eyes; expected an even {}", across, upwards,
                           beside ? "width" : "height"));
        return;
    }
    // Width over height of a pixel, and of one in the picture of an eye.
    const double pixel_aspect = width(wall) / across / (height(wall) / upwards);
    const double eye_pixel_aspect = beside ? 2.0 * pixel_aspect : above ? 0.5 * pixel_aspect : pixel_aspect;
    const auto is_square = [](double ratio) { return std::abs(ratio - 1.0) <= pixel_tolerance; };
    // Either ratio may be 1: a screen that takes both pictures squeezed into one has square pixels itself.
    if (is_square(eye_pixel_aspect) || is_square(pixel_aspect) || !(height(wall) > 0.0)) return;
    report(findings, false, placed,
           fmt::format("its pixels are not square: {:.3g} m by {:.3g} m with {}x{} pixels{}, so a pixel is "
                       "{:.3f} times as wide as high",
                       width(wall), height(wall), across, upwards, beside || above ? " for two eyes" : "",
                       eye_pixel_aspect));
}

// Returns true if both outputs name the same monitor, or rectangles of the same desktop that overlap.
bool collide(const PlacedOutput& a, const PlacedOutput& b) {
    const DisplayOutput &one = *a.output, &other = *b.output;
    if (one.process != other.process || !is_same_display(a.display, b.display)) return false;
    if (a.rect && b.rect) return has_pixels(common_part(*a.rect, *b.rect));
    return (!one.monitor.empty() && one.monitor == other.monitor) ||
           (one.monitor_index && one.monitor_index == other.monitor_index);
}

}  // namespace

const HostMonitor* find_monitor(const DisplayOutput& output, std::span<const HostMonitor> monitors) {
    if (output.monitor_index) {
        const auto index = static_cast<std::size_t>(*output.monitor_index);
        return index < monitors.size() ? &monitors[index] : nullptr;
    }
    for (const HostMonitor& monitor : monitors)
        if (!output.monitor.empty() && monitor.name == output.monitor) return &monitor;
    return nullptr;
}

bool is_same_display(std::string_view a, std::string_view b) { return x_screen(a) == x_screen(b); }

std::vector<DisplayFinding> check_outputs(const DisplayFile& displays, const DisplayHost& host) {
    DisplayFindings findings;
    std::vector<PlacedOutput> outputs = outputs_of(displays);
    for (PlacedOutput& placed : outputs) {
        const DisplayOutput& output = *placed.output;
        if (output.process == host.process) {
            if (placed.display.empty()) placed.display = host.display;
            if (!host.display.empty() && !is_same_display(placed.display, host.display))
                report(findings, true, placed,
                       fmt::format("its output is on the X display {}; expected {}, that of the program",
                                   in_quotes(output.display), in_quotes(host.display)));
            else if (!host.monitors.empty())
                assign_monitor(placed, host.monitors, findings);
        }
        check_pixels(placed, findings);
    }
    for (std::size_t i = 0; i < outputs.size(); ++i)
        for (std::size_t j = i + 1; j < outputs.size(); ++j)
            if (collide(outputs[i], outputs[j]))
                findings.push_back(
                    {true,
                     fmt::format("{} and {} are shown on the same pixels; expected an output for each",
                                 outputs[i].label, outputs[j].label),
                     outputs[j].index});
    return findings;
}

}  // namespace bolt::content
