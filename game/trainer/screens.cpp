// The screens of the trainer that are made of buttons: menu, pause, result.
#include <fmt/format.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <array>

#include "game/trainer/app.hpp"
#include "game/trainer/hud.hpp"

namespace bolt::trainer {

namespace {

constexpr ImGuiWindowFlags panel = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar;

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

void begin_panel(const char* name, const glm::dvec2& size, float width) {
    ImGui::SetNextWindowPos({static_cast<float>(0.5 * size.x), static_cast<float>(0.5 * size.y)},
                            ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, static_cast<float>(size.y)});
    ImGui::SetNextWindowBgAlpha(0.94F);
    ImGui::Begin(name, nullptr, panel);
}

template <class Value>
void radio(const char* label, Value& value, Value to) {
    if (ImGui::RadioButton(label, value == to)) value = to;
    ImGui::SameLine();
}

void text_field(const char* label, std::string& value) {
    std::array<char, 64> buffer{};
    value.copy(buffer.data(), buffer.size() - 1);
    if (ImGui::InputText(label, buffer.data(), buffer.size())) value = buffer.data();
}

}  // namespace

bool App::button(const char* label) {
    const bool pressed = ImGui::Button(label, {-1.0F, 0.0F});
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    buttons_.push_back({label, {0.5F * (low.x + high.x), 0.5F * (low.y + high.y)}});
    return pressed;
}

void App::draw_menu(const glm::dvec2& size) {
    Choice& choice = options_.choice;
    const float scale = input_.scale;
    begin_panel("##menu", size, 460.0F * scale);
    text("Boltwright");
    ImGui::Separator();
    for (const Listed& listed : listed_) {
        const bool chosen = listed.name == choice.assembly;
        if (ImGui::Selectable(listed.title.c_str(), chosen) && !chosen) {
            choice.assembly = listed.name;
            choice.variant.clear();
        }
    }
    ImGui::Separator();
    radio("guided", choice.mode, lesson::Mode::guided);
    radio("practice", choice.mode, lesson::Mode::practice);
    radio("assessment", choice.mode, lesson::Mode::assessment);
    ImGui::NewLine();
    radio("tighten", choice.task, lesson::Task::tighten);
    radio("loosen", choice.task, lesson::Task::loosen);
    ImGui::NewLine();
    text_field("name", choice.trainee);
    ImGui::Separator();
    if (trouble_) {
        ImGui::PushStyleColor(ImGuiCol_Text, {1.0F, 0.55F, 0.45F, 1.0F});
        ImGui::TextWrapped("%s", trouble_->message().c_str());
        ImGui::PopStyleColor();
    }
    if (button("Start")) start_wished_ = true;
    ImGui::SetItemDefaultFocus();
    if (button("Quit")) closed_ = true;
    ImGui::End();
}

void App::draw_pause(const glm::dvec2& size) {
    begin_panel("##pause", size, 300.0F * input_.scale);
    text("Paused");
    ImGui::Separator();
    if (button("Go on")) playing_->paused = false;
    if (button("End the lesson")) {
        playing_->paused = false;
        end_wished_ = true;
    }
    if (button("Quit")) closed_ = true;
    ImGui::End();
}

void App::draw_result(const glm::dvec2& size) {
    const lesson::LessonResult& result = played_->result;
    const float scale = input_.scale;
    ImGui::SetNextWindowPos({static_cast<float>(size.x) - 12.0F * scale, 12.0F * scale}, ImGuiCond_Always,
                            {1.0F, 0.0F});
    ImGui::SetNextWindowBgAlpha(0.9F);
    ImGui::Begin("##result", nullptr, panel);
    text(fmt::format("{:.0f} of 100   {:.0f} s", result.score, result.duration));
    ImGui::Separator();
    if (ImGui::BeginTable("joints", 5, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
        for (const char* head : {"", "N·m", "°", "kN", ""}) ImGui::TableSetupColumn(head);
        ImGui::TableHeadersRow();
        for (const lesson::JointResult& joint : result.joints) {
            for (const std::string& cell :
                 {joint.id, fmt::format("{:.1f}", joint.torque),
                  fmt::format("{:.0f}", to_degrees(joint.angle)), fmt::format("{:.1f}", joint.clamp / 1e3),
                  std::string(lesson::name(joint.overall))}) {
                ImGui::TableNextColumn();
                text(cell);
            }
        }
        ImGui::EndTable();
    }
    for (const lesson::ScoreReason& reason : result.reasons)
        text(fmt::format("{:+.0f}  {}", reason.points, reason.text));
    ImGui::Separator();
    if (button("Again")) start_wished_ = true;
    if (options_.menu && button("Menu")) shows_ = Shows::menu;
    if (button("Quit")) closed_ = true;
    ImGui::End();
}

void App::draw_interface(const glm::dvec2& size) {
    buttons_.clear();
    if (shows_ == Shows::lesson) draw_hud(*playing_, size, input_.scale);
    if (shows_ == Shows::lesson && playing_->paused) draw_pause(size);
    if (shows_ == Shows::menu) draw_menu(size);
    if (shows_ == Shows::result) draw_result(size);
}

}  // namespace bolt::trainer
