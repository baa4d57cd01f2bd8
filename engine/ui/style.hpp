// The style of the user interface.
#pragma once

#include <imgui/imgui.h>

namespace bolt::ui {

// Lengths are points times `scale`. Colours are blended linearly (see shaders/overlay.frag), so that
// translucent colours let a bright background through more than with blending of encoded values.
ImGuiStyle make_style(float scale);

}  // namespace bolt::ui
