#include "game/trainer/room_bar.hpp"

#include <imgui/imgui.h>

#include <string_view>

#include "engine/xr/controller_profiles.hpp"

namespace bolt::trainer {

namespace {

// Points. A button of 64 dmm (mm at 1 m) is hit without effort (Google Daydream's guideline); a point
// has 1.33 dmm.
constexpr float button_height = 48.0F, bar_width = 196.0F;

}  // namespace

words::TextKey controls_text(const xr::ControllerProfile* controller) {
    const std::string_view path = controller != nullptr ? controller->path : "";
    for (const auto& [part, text] :
         {std::pair{std::string_view("/touch_controller"), words::TextKey("room.controls.touch")},
          {"/index_controller", words::TextKey("room.controls.index")},
          {"/vive_controller", words::TextKey("room.controls.vive")},
          {"/motion_controller", words::TextKey("room.controls.motion")},
          {"/simple_controller", words::TextKey("room.controls.simple")}})
        if (path.find(part) != std::string_view::npos) return text;
    return "room.controls.hands";
}

ScreenAction draw_room_bar(const ScreenContext& context, const RoomBar& bar) {
    const float scale = context.scale, half = 0.5F * (bar_width - 8.0F) * scale;
    ScreenAction action = ScreenAction::none;
    ImGui::SetNextWindowPos({12.0F * scale, static_cast<float>(0.5 * context.size.y)}, ImGuiCond_Always,
                            {0.0F, 0.5F});
    ImGui::SetNextWindowBgAlpha(0.78F);
    ImGui::Begin("##room", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoFocusOnAppearing);
    const auto button = [&](words::TextKey key, float width, ScreenAction pressed) {
        if (ImGui::Button(context.words[key].c_str(), {width, button_height * scale})) action = pressed;
        note_widget(context, key);
    };
    button("room.pause", bar_width * scale, ScreenAction::pause);
    if (bar.second_wrench) button("action.second_wrench", bar_width * scale, ScreenAction::second_wrench);
    if (bar.moves_workpiece) {
        button("room.turn_left", half, ScreenAction::turn_left);
        ImGui::SameLine(0.0F, 8.0F * scale);
        button("room.turn_right", half, ScreenAction::turn_right);
        button("room.raise", half, ScreenAction::raise);
        ImGui::SameLine(0.0F, 8.0F * scale);
        button("room.lower", half, ScreenAction::lower);
    }
    draw_wrapped(context.words[bar.controls], muted_text, bar_width * scale);
    note_widget(context, bar.controls);
    ImGui::End();
    return action;
}

}  // namespace bolt::trainer
