// Converts ParaView's description of a cave (.pvx, XML) to a display file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "content/displays/display_file.hpp"

namespace bolt::content {

// Errors and warnings name file, line and column. A warning names a part of the .pvx file that a
// display file cannot express.
struct ImportedDisplays {
    DisplayFile displays;
    std::vector<Error> warnings;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

struct PvxOptions {
    double scale = 1.0;  // metres per unit of the file's corners and eye separation
    // m, height of the file's origin above the floor; none: 0. In many files the origin is between the
    // viewer's eyes. If a height is given, the head is placed at the origin, provided that the origin is in
    // front of all walls.
    std::optional<double> eye_height{};
};

// Each Machine becomes a wall, with a window at its Geometry or, without one, on a monitor. Machines of one
// Name are shown by one process. Two machines with the same corners and the stereo types Left and Right
// become one wall with two outputs.
ImportedDisplays import_pvx(std::string_view text, const std::string& file, const PvxOptions& options = {});
ImportedDisplays load_pvx(const std::filesystem::path& path, const PvxOptions& options = {});

}  // namespace bolt::content
