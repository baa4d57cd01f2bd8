#include "content/displays/example_displays.hpp"

#include <algorithm>

namespace bolt::content {

namespace {

Wall window_wall(std::string name, const Vec3& lower_left, const Vec3& lower_right, const Vec3& upper_right,
                 PixelPosition position, PixelSize size) {
    Wall wall;
    wall.name = std::move(name);
    wall.lower_left = lower_left;
    wall.lower_right = lower_right;
    wall.upper_right = upper_right;
    wall.output.position = position;
    wall.output.resolution = size;
    return wall;
}

// The side behind the viewer is open. Five projectors side by side on one desktop; a pixel is 2 mm wide.
DisplayFile cave() {
    constexpr double half = 1.5, top = 2.4;  // m
    constexpr PixelSize side{1500, 1200}, floor{1500, 1500};
    DisplayFile file;
    file.name = "Cave";
    file.head.tracker = HeadTracker::dtrack;
    file.walls = {
        window_wall("left", {-half, 0, half}, {-half, 0, -half}, {-half, top, -half}, {0, 0}, side),
        window_wall("front", {-half, 0, -half}, {half, 0, -half}, {half, top, -half}, {1500, 0}, side),
        window_wall("right", {half, 0, -half}, {half, 0, half}, {half, top, half}, {3000, 0}, side),
        window_wall("floor", {-half, 0, half}, {half, 0, half}, {half, 0, -half}, {4500, 0}, floor),
        window_wall("ceiling", {-half, top, -half}, {half, top, -half}, {half, top, half}, {6000, 0}, floor),
    };
    return file;
}

DisplayFile single_wall() {
    DisplayFile file;
    file.name = "Wall";
    file.head.fixed_head.position = {0.0, 1.6, 2.0};
    Wall wall;
    wall.name = "wall";
    wall.lower_left = {-2.0, 0.3, 0.0};
    wall.lower_right = {2.0, 0.3, 0.0};
    wall.upper_right = {2.0, 2.55, 0.0};
    wall.output.monitor_index = 0;
    wall.output.resolution = PixelSize{3840, 2160};
    file.walls.push_back(wall);
    return file;
}

// Two screens of 65 inches, 1.44 m by 0.81 m, that meet at the far edge of the table: the smallest ones on
// which the panel's text has a comfortable size.
DisplayFile desk() {
    DisplayFile file;
    file.name = "Desk";
    file.head.fixed_head.position = {0.0, 1.2, 0.45};
    file.walls = {
        window_wall("screen", {-0.72, 0.75, -0.3}, {0.72, 0.75, -0.3}, {0.72, 1.56, -0.3}, {0, 0},
                    {1920, 1080}),
        window_wall("table", {-0.72, 0.75, 0.51}, {0.72, 0.75, 0.51}, {0.72, 0.75, -0.3}, {0, 1080},
                    {1920, 1080}),
    };
    return file;
}

}  // namespace

const std::vector<std::string>& display_kind_names() {
    static const std::vector<std::string> names{"wall", "cave", "desk"};
    return names;
}

DisplayFile example_displays(DisplayKind kind, StereoMode stereo) {
    DisplayFile file = kind == DisplayKind::cave   ? cave()
                       : kind == DisplayKind::desk ? desk()
                                                   : single_wall();
    int bottom = 0;  // of all windows, pixels
    for (const Wall& wall : file.walls)
        if (wall.output.position)
            bottom = std::max(bottom, wall.output.position->y + wall.output.resolution->height);
    for (Wall& wall : file.walls) {
        wall.stereo = stereo;
        if (stereo != StereoMode::two_outputs) continue;
        wall.right_output = wall.output;
        if (wall.right_output->position) wall.right_output->position->y += bottom;
        if (wall.right_output->monitor_index) ++*wall.right_output->monitor_index;
    }
    return file;
}

}  // namespace bolt::content
