#include "engine/ui/style.hpp"

namespace bolt::ui {

ImGuiStyle make_style(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = 6.0F;
    style.FrameRounding = style.GrabRounding = style.PopupRounding = 4.0F;
    style.WindowPadding = {12.0F, 10.0F};
    style.FramePadding = {8.0F, 5.0F};
    style.ItemSpacing = {8.0F, 6.0F};
    style.WindowBorderSize = 0.0F;
    style.WindowTitleAlign = {0.5F, 0.5F};
    ImVec4* c = style.Colors;
    c[ImGuiCol_Text] = {0.93F, 0.94F, 0.95F, 1.0F};
    c[ImGuiCol_TextDisabled] = {0.60F, 0.63F, 0.66F, 1.0F};
    c[ImGuiCol_WindowBg] = {0.10F, 0.12F, 0.14F, 0.975F};
    c[ImGuiCol_PopupBg] = {0.13F, 0.15F, 0.18F, 0.98F};
    c[ImGuiCol_TitleBg] = c[ImGuiCol_TitleBgCollapsed] = {0.13F, 0.16F, 0.19F, 0.96F};
    c[ImGuiCol_TitleBgActive] = {0.16F, 0.22F, 0.28F, 0.98F};
    c[ImGuiCol_FrameBg] = {0.20F, 0.23F, 0.27F, 1.0F};
    c[ImGuiCol_FrameBgHovered] = {0.25F, 0.30F, 0.35F, 1.0F};
    c[ImGuiCol_FrameBgActive] = {0.28F, 0.36F, 0.43F, 1.0F};
    c[ImGuiCol_Button] = {0.20F, 0.34F, 0.46F, 1.0F};
    c[ImGuiCol_ButtonHovered] = {0.24F, 0.43F, 0.58F, 1.0F};
    c[ImGuiCol_ButtonActive] = {0.16F, 0.50F, 0.70F, 1.0F};
    c[ImGuiCol_Header] = {0.20F, 0.34F, 0.46F, 1.0F};
    c[ImGuiCol_HeaderHovered] = {0.24F, 0.43F, 0.58F, 1.0F};
    c[ImGuiCol_HeaderActive] = {0.16F, 0.50F, 0.70F, 1.0F};
    c[ImGuiCol_CheckMark] = c[ImGuiCol_SliderGrabActive] = {0.45F, 0.80F, 1.00F, 1.0F};
    c[ImGuiCol_SliderGrab] = {0.35F, 0.62F, 0.80F, 1.0F};
    c[ImGuiCol_PlotHistogram] = {0.45F, 0.80F, 1.00F, 1.0F};
    style.ScaleAllSizes(scale);
    return style;
}

}  // namespace bolt::ui
