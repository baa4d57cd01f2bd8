#include "game/trainer/menu_pages.hpp"

#include <imgui/imgui.h>

namespace bolt::trainer {

namespace {

constexpr float page_width = 720.0F;  // points
constexpr glm::vec4 good_color{0.45F, 0.85F, 0.55F, 1.0F}, limited_color{1.0F, 0.82F, 0.4F, 1.0F};

// The marks differ in shape, so that they can be told apart without colours.
void draw_finding(const words::Words& words, const computer::Finding& finding) {
    const auto& [mark, color] = finding.severity == computer::Severity::good ? std::pair{"✓", good_color}
                                : finding.severity == computer::Severity::limited
                                    ? std::pair{"▲", limited_color}
                                    : std::pair{"✗", warning_text};
    const float indent = 2.0F * ImGui::GetFontSize();
    ImGui::TextColored({color.r, color.g, color.b, color.a}, "%s", mark);
    ImGui::SameLine(indent);
    ImGui::Indent(indent - ImGui::GetStyle().WindowPadding.x);
    draw_wrapped(words::format_text(words, finding.text, finding.arguments), {0.93F, 0.94F, 0.95F, 1.0F});
    if (finding.remedy) draw_wrapped(words[*finding.remedy], muted_text);
    ImGui::Unindent(indent - ImGui::GetStyle().WindowPadding.x);
}

void begin_page(const ScreenContext& context, const char* name, words::TextKey title) {
    const float most = static_cast<float>(context.size.x) - 24.0F * context.scale;
    begin_dialog(context, name, std::min(page_width * context.scale, most), 0.96F);
    ImGui::PushFont(context.heading);
    draw_text(context.words[title]);
    ImGui::PopFont();
    ImGui::Separator();
}

ScreenAction end_page(const ScreenContext& context) {
    ImGui::Separator();
    const bool back = draw_button(context, "menu.back");
    ImGui::SetItemDefaultFocus();
    ImGui::End();
    return back ? ScreenAction::close_page : ScreenAction::none;
}

}  // namespace

void ComputerCheck::start(GatherFacts gather_facts, const computer::FactsRequest& request) {
    if (running()) return;
    findings_.clear();
    gather_facts_ = std::move(gather_facts);
    request_ = request;
    with_timing_ = false;
    computer::FactsRequest quick = request;
    quick.seconds = 0.0;
    running_ = std::async(std::launch::async, gather_facts_, quick);
}

void ComputerCheck::update() {
    using namespace std::chrono_literals;
    if (!running() || running_.wait_for(0s) != std::future_status::ready) return;
    findings_ = computer::findings(running_.get());
    if (std::exchange(with_timing_, true)) return;
    running_ = std::async(std::launch::async, gather_facts_, request_);
}

ScreenAction draw_computer_page(const ScreenContext& context, const ComputerCheck& check) {
    begin_page(context, "##computer", "menu.computer");
    for (const computer::Finding& finding : check.findings()) draw_finding(context.words, finding);
    if (check.running()) draw_wrapped(context.words["computer.wait"], muted_text);
    return end_page(context);
}

ScreenAction draw_files_page(const ScreenContext& context, const UserFolders& folders) {
    const words::Words& words = context.words;
    begin_page(context, "##files", "menu.files");
    const auto paragraph = [&](words::TextKey key, const std::filesystem::path& folder) {
        draw_wrapped(words::format_text(words, key, {{"folder", folder.string()}}),
                     {0.93F, 0.94F, 0.95F, 1.0F});
        ImGui::Spacing();
    };
    paragraph(folders.folder_per_lesson ? words::TextKey("files.sessions") : words::TextKey("files.session"),
              folders.sessions);
    if (folders.settings.empty()) {
        paragraph("files.no_home", {});
    } else {
        paragraph("files.settings", folders.settings);
        paragraph("files.assemblies", folders.assemblies);
    }
    draw_wrapped(words["files.import"], muted_text);
    return end_page(context);
}

}  // namespace bolt::trainer
