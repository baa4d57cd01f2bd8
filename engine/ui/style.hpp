// How the interface looks.
#pragma once

#include <imgui/imgui.h>

namespace bolt::ui {

// Lengths in points times `scale`. Colours are for blending of light (see shaders/overlay.frag): what is half
// transparent shows more of a bright background than it would where encoded values are mixed.
ImGuiStyle make_style(float scale);

}  // namespace bolt::ui
