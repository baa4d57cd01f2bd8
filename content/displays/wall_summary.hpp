// A table of the walls, for the installer of a room.
#pragma once

#include <optional>
#include <string>

#include "content/displays/check_displays.hpp"

namespace bolt::content {

// Size, direction and distance of a wall, and the resolution of its picture.
struct WallSummary {
    double width = 0.0, height = 0.0;              // m
    double turn = 0.0;                             // rad about the vertical: 0 faces +z, pi/2 faces +x
    double tilt = 0.0;                             // rad: 0 upright, pi/2 faces up (a floor), -pi/2 down
    double distance = 0.0;                         // m, of the fixed head in front of the wall's plane
    double seen_width = 0.0, seen_height = 0.0;    // rad, angles between its edges, seen by the fixed head
    std::optional<PixelSize> resolution;           // of one eye's picture; none: unknown
    double pixel_width = 0.0, pixel_height = 0.0;  // m; 0: unknown
};

// `resolution`: of the output; none: unknown. The wall must have a width and a height.
WallSummary summarize(const Wall& wall, const Vec3& fixed_head, const std::optional<PixelSize>& resolution);

// The head's tracker, a line for each wall, and one for each pair of walls that meet, with their angle and
// the gap. The resolution of an output that fills a monitor is that of the monitor in `host`.
std::string list_walls(const DisplayFile& displays, const DisplayHost& host = {});

}  // namespace bolt::content
