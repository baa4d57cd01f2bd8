// Handles the end of the X display server while a window is open; by default, Xlib would exit the program.
#pragma once

namespace bolt::platform {

// Sets `lost` when the display server ends, instead of exiting; the owner of the windows then shuts down.
// Call it after initialising GLFW. `lost` must stay valid until GLFW has terminated.
void watch_display_loss(bool& lost);

}  // namespace bolt::platform
