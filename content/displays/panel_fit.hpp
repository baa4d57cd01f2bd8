// Where projection walls show the panel of menus and hints.
#pragma once

#include <optional>
#include <span>

#include "content/displays/display_file.hpp"

namespace bolt::content {

// The panel and the height of its text, in points.
inline constexpr double panel_width_points = 1160.0, panel_height_points = 760.0, panel_text_points = 15.0;
// The smallest text that reads without effort, dmm (mm at 1 m; Google Daydream's guideline).
inline constexpr double comfortable_text = 20.0;

// A panel in the plane of a wall: both eyes see it at the same pixels, and no edge of the wall cuts it.
struct PanelFit {
    std::size_t wall = 0;     // index
    Pose pose;                // of its centre in the room: x right, y up, z towards the viewer
    double point_size = 0.0;  // m
    double text_size = 0.0;   // dmm, seen from the head
};

// The panel on the wall that shows it best: with text of comfortable_text, or as large as the wall permits,
// near the direction in which the head looks, a little below the eyes. None: the head is in front of no wall.
std::optional<PanelFit> fit_panel(std::span<const Wall> walls, const Pose& head);

}  // namespace bolt::content
