// Names that the reader and the writer of a display file share.
#pragma once

#include <string>

#include "content/displays/display_file.hpp"

namespace bolt::content {

inline constexpr const char* displays_format = "boltwright displays 1";

// "+x", "-z", ...
std::string axis_name(const TrackerAxis& axis);

}  // namespace bolt::content
