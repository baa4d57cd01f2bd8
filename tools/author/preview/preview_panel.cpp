#include "tools/author/preview/preview_panel.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "engine/render/renderer.hpp"

namespace bolt::author {

namespace {

using namespace platform;

// Points. A narrower window has no room for the panel beside the model.
constexpr float least_width = 600.0F, least_height = 300.0F;
constexpr float panel_width = 300.0F, margin = 8.0F;
constexpr ImGuiWindowFlags preview_panel_flags =
    ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_AlwaysAutoResize;
constexpr ImU32 problem_text_color = IM_COL32(255, 140, 102, 255);

void draw_text(const std::string& text) { ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size()); }

std::string count_text(const PreviewPanelState& state) {
    const CheckedAssembly* checked = state.overlay.checked();
    if (checked == nullptr) return "The assembly is not checked";
    const std::size_t joints = checked->assembly.joints.size(), problems = state.overlay.problems().size();
    return fmt::format("{} joint{}, {} problem{}", joints, joints == 1 ? "" : "s",
                       problems == 0 ? "no" : fmt::to_string(problems), problems == 1 ? "" : "s");
}

}  // namespace

Status PreviewPanel::start(gpu::Device& device) {
    BOLT_TRY_ASSIGN(ui_, ui::Ui::create(device));
    return {};
}

void PreviewPanel::release() { ui_.reset(); }

bool PreviewPanel::is_shown() const {
    return ui_ && !hidden_ && input_.size.x >= least_width * input_.scale &&
           input_.size.y >= least_height * input_.scale;
}

bool PreviewPanel::contains(const glm::dvec2& at) const {
    const glm::vec2 p(at);
    return is_shown() && p.x >= place_.low.x && p.x <= place_.high.x && p.y >= place_.low.y &&
           p.y <= place_.high.y;
}

bool PreviewPanel::take_events(std::vector<InputEvent>& events, const glm::vec2& size, float scale) {
    input_.size = size;
    input_.scale = scale;
    input_.wheel = {};
    for (ui::UiButton& button : input_.buttons) button.pressed = false;
    ui::UiButton& left = input_.buttons[0];
    std::erase_if(events, [&](const InputEvent& event) {
        if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
            // The highlight of a line that the cursor leaves also has to be drawn again.
            if (contains(cursor->at) || contains(glm::dvec2(input_.pointer))) refresh();
            input_.pointer = cursor->at;
            input_.pointer_inside = true;
        } else if (const auto* button = std::get_if<ButtonEvent>(&event)) {
            const bool inside = contains(button->at);
            if (button->button != Button::left) return inside && button->down;
            if (!inside && !left.down) return false;
            input_.pointer = button->at;
            left.set(button->down && inside);
            refresh();
            return true;
        } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
            if (!contains(wheel->at)) return false;
            input_.wheel += glm::vec2(wheel->notches);
            refresh();
            return true;
        }
        return false;
    });
    if (frames_ == 0) return false;
    --frames_;
    return true;
}

// A list of lines that wrap, each of which can be clicked.
void PreviewPanel::draw_problems(const PreviewPanelState& state) {
    const std::vector<Problem>& problems = state.overlay.problems();
    const float width = ImGui::GetContentRegionAvail().x;
    for (std::size_t i = 0; i < problems.size(); ++i) {
        const std::string text = problem_text(*state.overlay.checked(), problems[i]);
        const auto joint = problems[i].joint;
        const bool is_selected =
            joint && state.overlay.checked()->assembly.joints[*joint].design.id == state.selected;
        const ImVec2 size = ImGui::CalcTextSize(text.c_str(), text.c_str() + text.size(), false, width);
        const ImVec2 at = ImGui::GetCursorPos();
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Selectable("##problem", is_selected, 0, ImVec2(width, size.y))) commands_.problem = i;
        ImGui::PopID();
        const ImVec2 next = ImGui::GetCursorPos();
        ImGui::SetCursorPos(at);
        ImGui::PushTextWrapPos(at.x + width);
        ImGui::PushStyleColor(ImGuiCol_Text, problem_text_color);
        draw_text(text);
        ImGui::PopStyleColor();
        ImGui::PopTextWrapPos();
        ImGui::SetCursorPos(next);
    }
}

void PreviewPanel::draw_contents(const PreviewPanelState& state) {
    for (std::size_t i = 0; i < state.variants.size(); ++i)
        if (ImGui::RadioButton(state.variants[i].empty() ? "without a variant" : state.variants[i].c_str(),
                               state.variants[i] == state.variant))
            commands_.variant = i;
    if (!state.variants.empty()) ImGui::Separator();
    bool all = state.all_sectors;
    if (ImGui::Checkbox("Swing of all joints", &all)) commands_.toggle_sectors = true;
    const auto [checked, joints] = state.check.progress();
    if (!state.check.is_running())
        draw_text(count_text(state));
    else if (joints == 0)
        draw_text("Reading the models");
    else
        draw_text(fmt::format("Checking joint {} of {}", std::min(checked + 1, joints), joints));
    if (!state.overlay.problems().empty()) {
        ImGui::Separator();
        draw_problems(state);
    }
    const std::string description =
        state.selected.empty() ? std::string() : state.overlay.description_of(state.selected);
    if (description.empty()) return;
    ImGui::Separator();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x);
    draw_text(fmt::format("{}: {}", state.selected, description));
    ImGui::PopTextWrapPos();
}

Status PreviewPanel::draw(gpu::FrameContext& frame, render::Renderer& renderer,
                          const PreviewPanelState& state) {
    if (!is_shown()) return {};
    for (const Problem& problem : state.overlay.problems())
        ui_->add_characters(problem_text(*state.overlay.checked(), problem));
    for (const std::string& variant : state.variants) ui_->add_characters(variant);
    ui_->add_characters(state.selected);
    ui_->add_characters(state.overlay.description_of(state.selected));
    BOLT_TRY(ui_->begin(frame, input_));
    const float scale = input_.scale, edge = margin * scale, width = panel_width * scale;
    ImGui::SetNextWindowPos({edge, edge});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, input_.size.y - 2.0F * edge});
    if (ImGui::Begin("##preview", nullptr, preview_panel_flags)) {
        draw_contents(state);
        const ImVec2 low = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
        place_ = {{low.x, low.y}, {low.x + size.x, low.y + size.y}};
    }
    ImGui::End();
    const render::Overlay overlay = ui_->end();
    return renderer.draw_over(frame, overlay, renderer.picture(0));
}

}  // namespace bolt::author
