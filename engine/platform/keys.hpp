// Keys as GLFW tells them, in ours.
#pragma once

#include "engine/platform/input.hpp"

namespace bolt::platform {

// `printed`: what GLFW says the layout prints on the key; may be null.
Key key_of(int glfw_key, const char* printed);

}  // namespace bolt::platform
