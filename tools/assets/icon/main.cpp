// Draws the program's icon as SVG: an open-end wrench on the nut of an M16 bolt, seen along the axis.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string>

#include "engine/base/file.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/program/program.hpp"

namespace bolt::icon {
namespace {

// Millimetres about the bolt's axis, y down as in SVG.
struct Point {
    double x = 0.0, y = 0.0;
};

// ISO 4032 and ISO 261, M16.
constexpr double across_flats = 24.0, thread = 16.0, thread_core = 13.835;
// An open-end wrench of this size (DIN 3110) is about 53 mm wide, with its jaw 15° off the handle.
constexpr double head_radius = 26.5, handle_width = 18.0, handle_length = 74.0, head_angle_deg = 15.0;
constexpr double tilt_deg = 45.0;  // of the handle in the picture
constexpr double size = 128.0;     // of the picture

Point turned(Point p, double degrees) {
    const double angle = to_radians(degrees);
    return {p.x * std::cos(angle) - p.y * std::sin(angle), p.x * std::sin(angle) + p.y * std::cos(angle)};
}

std::string path_through(std::span<const Point> points, double degrees) {
    std::string path;
    for (const Point& p : points) {
        const Point at = turned(p, degrees);
        path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", at.x, at.y);
    }
    return path + "Z";
}

// The head is a disc with a slot for the nut, open away from the handle.
std::string wrench() {
    const double half = across_flats / 2 + 0.3, bottom = across_flats / std::sqrt(3.0);
    const double edge = std::sqrt(head_radius * head_radius - half * half);
    const Point tip_a = turned({half, -edge}, head_angle_deg), tip_b = turned({-half, -edge}, head_angle_deg);
    const Point in_a = turned({half, bottom * 0.5}, head_angle_deg),
                in_b = turned({-half, bottom * 0.5}, head_angle_deg);
    const Point low = turned({0.0, bottom}, head_angle_deg);
    std::string path;
    for (const Point& p : {tip_b, in_b, low, in_a, tip_a}) {
        const Point at = turned(p, tilt_deg);
        path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", at.x, at.y);
    }
    const Point end = turned(tip_b, tilt_deg);
    path += fmt::format("A{0} {0} 0 1 1 {1:.2f} {2:.2f}Z", head_radius, end.x, end.y);
    return path;
}

std::string handle() {
    const double half = handle_width / 2;
    const std::array<Point, 4> corners{Point{-half, head_radius * 0.8},
                                       {-half, handle_length},
                                       {half, handle_length},
                                       {half, head_radius * 0.8}};
    return path_through(corners, tilt_deg);
}

std::string nut() {
    std::array<Point, 6> corners;
    const double radius = across_flats / std::sqrt(3.0);
    for (std::size_t i = 0; i < corners.size(); ++i)
        corners.at(i) = turned({0.0, -radius}, 60.0 * static_cast<double>(i) + head_angle_deg);
    return path_through(corners, tilt_deg);
}

std::string drawing() {
    // The bolt lies towards the upper right, so that the handle fills the lower left.
    return fmt::format(
        R"svg(<svg xmlns="http://www.w3.org/2000/svg" width="{0}" height="{0}" viewBox="0 0 {0} {0}">
<title>Boltwright</title>
<defs>
<linearGradient id="steel" x1="0" y1="0" x2="1" y2="1"><stop offset="0" stop-color="#e8edf2"/><stop offset="1" stop-color="#8d9aa6"/></linearGradient>
<linearGradient id="back" x1="0" y1="0" x2="0" y2="1"><stop offset="0" stop-color="#27475f"/><stop offset="1" stop-color="#13212d"/></linearGradient>
</defs>
<rect x="4" y="4" width="120" height="120" rx="26" fill="url(#back)"/>
<g transform="translate(78 48) scale(1.12)" stroke-linejoin="round">
<path d="{1}" fill="url(#steel)" stroke="#0b141b" stroke-width="1.2"/>
<path d="{2}" fill="url(#steel)" stroke="url(#steel)" stroke-width="6" clip-path="none"/>
<path d="{3}" fill="#f0b23c" stroke="#5e3d05" stroke-width="1.4"/>
<circle r="{4}" fill="none" stroke="#5e3d05" stroke-width="0.8" opacity="0.6"/>
<circle r="{5}" fill="#d4dae0" stroke="#3a4652" stroke-width="1.2"/>
<circle r="{6}" fill="none" stroke="#3a4652" stroke-width="0.8" stroke-dasharray="32 11"/>
</g>
</svg>
)svg",
        size, wrench(), handle(), nut(), across_flats / 2 - 0.8, thread / 2, thread_core / 2);
}

}  // namespace
}  // namespace bolt::icon

int main(int argc, char** argv) {
    CLI::App app("Draws the icon of Boltwright as SVG.", "bolt-icon");
    std::string file;
    int exit_code = 0;
    app.add_option("-o,--output", file, "SVG file to write")->required();
    app.callback([&] {
        if (const bolt::Status written = bolt::write_file(file, bolt::icon::drawing()); !written)
            exit_code = bolt::print_error(written.error());
    });
    return bolt::run_command_line(app, argc, argv, exit_code);
}
