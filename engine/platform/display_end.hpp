// What happens when the display server ends while a window is open: Xlib would end the program.
#pragma once

namespace bolt::platform {

// From now on `gone` is set instead; whoever owns the windows ends in order. After GLFW began. `gone` stays
// where it is until GLFW has ended.
void note_display_end(bool& gone);

}  // namespace bolt::platform
