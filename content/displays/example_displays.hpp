// Display files to begin with.
#pragma once

#include <string_view>
#include <vector>

#include "content/displays/display_file.hpp"

namespace bolt::content {

enum class DisplayKind : std::uint8_t {
    wall,  // one wall of 4 m by 2.25 m, without a tracker
    cave,  // front, left, right, floor and ceiling of 3 m by 2.4 m by 3 m, with a DTrack
    desk,  // an upright screen and one that lies on the table before it, for one seated viewer
};
const std::vector<std::string>& display_kind_names();  // in the order of the enumerators

// A file that all checks accept, without a schema. `stereo`: of all walls; with two_outputs the pictures of
// the right eyes are below those of the left eyes.
DisplayFile example_displays(DisplayKind kind, StereoMode stereo = StereoMode::mono);

}  // namespace bolt::content
