#include "tests/displays/support.hpp"

namespace displays_test {

using namespace bolt;
using namespace bolt::content;

std::string everything() {
    return R"({
  "$schema": "displays.schema.json",
  "format": "boltwright displays 1",
  "name": "Room 4",
  "eye_separation_m": 0.061,
  "head": {
    "tracker": "dtrack",
    "fixed": { "position_m": [0.1, 1.7, 0.2], "orientation_wxyz": [0.6, 0, 0.8, 0] },
    "port": 5001,
    "body": 3, "flystick": { "id": 2, "aim_in_body": { "position_m": [0, 0.01, -0.1] }, "select": 4, "menu": 1, "tool": 0 }, "pose": "right_hand",
    "recording": "walk.csv",
    "axes": ["+x", "+z", "-y"],
    "scale": 0.5,
    "tracker_in_room": { "position_m": [0, 0, 1] },
    "head_in_body": { "position_m": [0, -0.06, 0.02], "orientation_wxyz": [0, 1, 0, 0] },
    "hold_s": 0.25,
    "fade_s": 1.5,
    "max_speed_m_per_s": 3,
    "jump_s": 0.2
  },
  "walls": [
    { "name": "front", "lower_left_m": [-1.5, 0, -1.5], "lower_right_m": [1.5, 0, -1.5], "upper_right_m": [1.5, 2.4, -1.5],
      "stereo": "two_outputs", "swap_eyes": true,
      "left_output": { "monitor": "DP-1" },
      "right_output": { "monitor_index": 1, "resolution_px": [1500, 1200] } },
    { "name": "left", "lower_left_m": [-1.5, 0, 1.5], "lower_right_m": [-1.5, 0, -1.5], "upper_right_m": [-1.5, 2.4, -1.5],
      "stereo": "side_by_side",
      "output": { "position_px": [0, -20], "resolution_px": [1500, 1200], "display": ":0.1", "rank": 2 } }
  ]
}
)";
}

Wall front_wall(const std::string& name) {
    Wall wall;
    wall.name = name;
    wall.lower_left = {-1.5, 0.0, -1.5};
    wall.lower_right = {1.5, 0.0, -1.5};
    wall.upper_right = {1.5, 2.4, -1.5};
    wall.output.position = PixelPosition{0, 0};
    wall.output.resolution = PixelSize{1500, 1200};
    return wall;
}

Wall turned_wall(const std::string& name, double degrees) {
    const Quat turn = rotation(Vec3(0.0, to_radians(degrees), 0.0));
    Wall wall = front_wall(name);
    for (Vec3* corner : {&wall.lower_left, &wall.lower_right, &wall.upper_right}) *corner = turn * *corner;
    return wall;
}

Wall moved(Wall wall, const Vec3& by) {
    for (Vec3* corner : {&wall.lower_left, &wall.lower_right, &wall.upper_right}) *corner += by;
    return wall;
}

DisplayFile with_walls(std::vector<Wall> walls) {
    DisplayFile file;
    file.walls = std::move(walls);
    // Windows side by side, unless a test gives them other places.
    int x = 0;
    for (Wall& wall : file.walls) {
        if (wall.output.position && *wall.output.position == PixelPosition{0, 0}) wall.output.position->x = x;
        if (wall.output.resolution) x += wall.output.resolution->width;
    }
    return file;
}

std::vector<std::string> mistakes(std::string_view text) {
    std::vector<std::string> all;
    for (const Error& error : parse_displays(text, "d.json").errors) {
        CHECK(error.code == ErrorCode::bad_content);
        CHECK(error.line > 0);
        CHECK(error.column > 0);
        all.push_back(error.message());
    }
    return all;
}

std::vector<std::string> texts(const std::vector<DisplayFinding>& findings) {
    std::vector<std::string> all;
    for (const DisplayFinding& finding : findings)
        all.push_back((finding.prevents_use ? "" : "warning: ") + finding.text);
    return all;
}

}  // namespace displays_test
