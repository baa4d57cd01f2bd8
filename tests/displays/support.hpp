// Display files to edit, and the messages as a fitter reads them.
#pragma once

#include <doctest/doctest.h>

#include <string>
#include <string_view>
#include <vector>

#include "content/displays/check_displays.hpp"
#include "content/displays/display_file.hpp"

namespace displays_test {

// A correct file with every member of the schema, one in each line where possible.
std::string everything();

// One wall of 3 m by 2.4 m, 1.5 m in front of the default head, in a window of 1500x1200 pixels.
bolt::content::Wall front_wall(const std::string& name = "front");

// The front wall of 3 m by 2.4 m, turned by `degrees` about the vertical through the origin.
bolt::content::Wall turned_wall(const std::string& name, double degrees);

// The wall, moved.
bolt::content::Wall moved(bolt::content::Wall wall, const bolt::Vec3& by);

bolt::content::DisplayFile with_walls(std::vector<bolt::content::Wall> walls);

// The messages of parse_displays for a file "d.json".
std::vector<std::string> mistakes(std::string_view text);

// The texts of findings; those that do not prevent the use begin with "warning: ".
std::vector<std::string> texts(const std::vector<bolt::content::DisplayFinding>& findings);

inline bool has(const std::string& text, std::string_view part) {
    return text.find(part) != std::string::npos;
}

}  // namespace displays_test
