// Maps GLFW's keys to Key.
#pragma once

#include "engine/platform/input.hpp"

namespace bolt::platform {

// `printed`: the layout's name of the key from GLFW; may be null.
Key key_of(int glfw_key, const char* printed);

}  // namespace bolt::platform
