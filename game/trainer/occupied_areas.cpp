#include "game/trainer/occupied_areas.hpp"

// The public interface tells a window's place only while that window is being filled.
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>

namespace bolt::trainer {

std::vector<render::Rectangle> occupied_areas() {
    std::vector<render::Rectangle> plates;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        const bool own = (window->Flags & ImGuiWindowFlags_ChildWindow) == 0 && !window->IsFallbackWindow;
        if (!own || !window->Active || window->Hidden) continue;
        const ImVec2 high = {window->Pos.x + window->Size.x, window->Pos.y + window->Size.y};
        plates.push_back({{window->Pos.x, window->Pos.y}, {high.x, high.y}});
    }
    return plates;
}

}  // namespace bolt::trainer
