#include "game/trainer/screens.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>

#include "game/lesson/feedback.hpp"
#include "game/view/labels.hpp"

namespace bolt::trainer {

namespace {

constexpr ImGuiWindowFlags panel_flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar;

ImVec4 to_imgui(const glm::vec4& color) { return {color.r, color.g, color.b, color.a}; }

void draw_joint_table(const words::Words& words, std::span<const lesson::JointResult> joints) {
    if (!ImGui::BeginTable("joints", 5, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) return;
    for (const char* head : {"", "N·m", "°", "kN", ""}) ImGui::TableSetupColumn(head);
    ImGui::TableHeadersRow();
    for (const lesson::JointResult& joint : joints)
        for (const std::string& cell :
             {joint.id, fmt::format("{:.1f}", joint.torque), fmt::format("{:.0f}", to_degrees(joint.angle)),
              fmt::format("{:.1f}", joint.clamp / 1e3),
              fmt::format("{} {}", view::symbol_of(view::verdict_of(joint)),
                          words[lesson::text_key(joint.overall)])}) {
            ImGui::TableNextColumn();
            draw_text(cell);
        }
    ImGui::EndTable();
}

}  // namespace

void note_widget(const ScreenContext& context, words::TextKey key) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    context.drawn_widgets.push_back(
        {key, {0.5F * (low.x + high.x), 0.5F * (low.y + high.y)}, high.x - low.x});
}

bool draw_button(const ScreenContext& context, words::TextKey key) {
    const bool pressed = ImGui::Button(context.words[key].c_str(), {-1.0F, 0.0F});
    note_widget(context, key);
    return pressed;
}

void draw_text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

void draw_wrapped(const std::string& line, const glm::vec4& color, float width) {
    ImGui::PushTextWrapPos(width > 0.0F ? ImGui::GetCursorPosX() + width : 0.0F);
    ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(color));
    draw_text(line);
    ImGui::PopStyleColor();
    ImGui::PopTextWrapPos();
}

bool draw_choice_button(const std::string& label, bool is_chosen) {
    const ImVec4 chosen{0.16F, 0.47F, 0.66F, 1.0F}, not_chosen{0.17F, 0.20F, 0.24F, 1.0F};
    ImGui::PushStyleColor(ImGuiCol_Button, is_chosen ? chosen : not_chosen);
    const bool pressed = ImGui::Button(label.c_str());
    ImGui::PopStyleColor();
    return pressed;
}

namespace {

struct DialogLook {
    float width = 0.0F, opacity = 1.0F;
};

// `anchor`: the point of the dialog, as shares of its size, that is at `at` (px).
void begin_dialog_at(const ScreenContext& context, const char* name, const glm::vec2& at,
                     const glm::vec2& anchor, const DialogLook& look) {
    ImGui::SetNextWindowPos({at.x, at.y}, ImGuiCond_Always, {anchor.x, anchor.y});
    ImGui::SetNextWindowSizeConstraints({look.width, 0.0F}, {look.width, static_cast<float>(context.size.y)});
    ImGui::SetNextWindowBgAlpha(look.opacity);
    ImGui::Begin(name, nullptr, panel_flags);
}

}  // namespace

void begin_dialog(const ScreenContext& context, const char* name, float width, float opacity) {
    begin_dialog_at(context, name, glm::vec2(0.5 * context.size), {0.5F, 0.5F}, {width, opacity});
}

void begin_dialog_at_right(const ScreenContext& context, const char* name, float width, float opacity) {
    const glm::vec2 at(static_cast<float>(context.size.x) - 12.0F * context.scale, 0.5 * context.size.y);
    begin_dialog_at(context, name, at, {1.0F, 0.5F}, {width, opacity});
}

void draw_languages(const ScreenContext& context, content::TraineeSettings& settings) {
    for (const words::Words& language : context.languages)
        if (ImGui::RadioButton(language.name.c_str(), language.language == context.words.language)) {
            context.selected_language = language.language;
            settings.language = language.language;
        } else {
            ImGui::SameLine();
        }
    ImGui::NewLine();
}

void draw_settings_file(const ScreenContext& context, const Preferences& preferences) {
    switch (preferences.file_error) {
        case Preferences::FileError::read_failed:
            return draw_wrapped(words::format_text(context.words, "settings.unread",
                                                   {{"why", preferences.file_error_message}}),
                                warning_text);
        case Preferences::FileError::write_failed:
            return draw_wrapped(words::format_text(context.words, "settings.unwritten",
                                                   {{"why", preferences.file_error_message}}),
                                warning_text);
        case Preferences::FileError::none:
            break;
    }
    if (settings_file(preferences).empty())
        draw_wrapped(context.words["settings.not_kept"], muted_text);
    else if (!preferences.trainee.empty())
        draw_wrapped(
            words::format_text(context.words, "settings.kept",
                               {{"trainee", preferences.display_name.empty() ? preferences.trainee
                                                                             : preferences.display_name}}),
            muted_text);
}

ScreenAction draw_pause(const ScreenContext& context, const Preferences& preferences, lesson::Mode mode,
                        const PauseOptions& options) {
    ScreenAction action = ScreenAction::none;
    begin_dialog(context, "##pause", 300.0F * context.scale, 0.94F);
    draw_text(context.words["menu.paused"]);
    ImGui::Separator();
    if (options.headset_lost) draw_wrapped(context.words["room.lost"], warning_text);
    if (preferences.file_error != Preferences::FileError::none) draw_settings_file(context, preferences);
    if (draw_button(context,
                    options.headset_lost ? words::TextKey("room.use_mouse") : words::TextKey("menu.go_on")))
        action = ScreenAction::resume;
    if (mode != lesson::Mode::assessment) {
        if (draw_button(context, "menu.undo")) action = ScreenAction::undo_step;
        if (draw_button(context, "menu.restart_step")) action = ScreenAction::restart_step;
    }
    if (options.in_room) {
        struct RoomButton {
            words::TextKey label;
            ScreenAction action;
        };
        constexpr RoomButton buttons[] = {{"action.place_again", ScreenAction::place_again},
                                          {"action.turn_left", ScreenAction::turn_left},
                                          {"action.turn_right", ScreenAction::turn_right},
                                          {"action.raise", ScreenAction::raise},
                                          {"action.lower", ScreenAction::lower}};
        for (const RoomButton& button : buttons)
            if (draw_button(context, button.label)) action = button.action;
    }
    if (draw_button(context, "menu.settings")) action = ScreenAction::open_settings;
    if (draw_button(context, "menu.end")) action = ScreenAction::end_lesson;
    if (draw_button(context, "menu.quit")) action = ScreenAction::quit;
    ImGui::End();
    return action;
}

ScreenAction draw_result(const ScreenContext& context, const content::Assembly& assembly,
                         const lesson::LessonResult& result, const ResultOptions& options) {
    const words::Words& words = context.words;
    const float scale = context.scale, height = static_cast<float>(context.size.y);
    ScreenAction action = ScreenAction::none;
    ImGui::SetNextWindowPos({static_cast<float>(context.size.x) - 12.0F * scale, 12.0F * scale},
                            ImGuiCond_Always, {1.0F, 0.0F});
    ImGui::SetNextWindowSizeConstraints({380.0F * scale, 0.0F}, {380.0F * scale, height - 24.0F * scale});
    ImGui::SetNextWindowBgAlpha(0.9F);
    ImGui::Begin("##result", nullptr, panel_flags);
    draw_text(words::format_text(words, "result.score", {{"points", words::Number{result.score, 0}}}) +
              fmt::format("   {:.0f} s", result.duration));
    ImGui::Separator();
    // Above the table, which may be longer than the picture, so that the buttons are always visible.
    if (options.tour) draw_wrapped(words["tour.done"], muted_text);
    if (options.study && draw_button(context, "study.next")) action = ScreenAction::show_menu;
    if (!options.study && draw_button(context, "menu.again")) action = ScreenAction::start_lesson;
    if (options.menu && draw_button(context, "menu.menu")) action = ScreenAction::show_menu;
    if (draw_button(context, "menu.quit")) action = ScreenAction::quit;
    ImGui::Separator();
    draw_joint_table(words, result.joints);
    const lesson::Review review = lesson::review(assembly, result);
    ImGui::PushTextWrapPos(340.0F * scale);
    for (const lesson::DeductionText& reason : review.reasons)
        draw_text((reason.points != 0.0 ? fmt::format("{:+.0f}  ", reason.points) : std::string()) +
                  lesson::deduction_text(words, reason));
    ImGui::Separator();
    for (const words::TextKey advice : review.advice)
        draw_text(words::format_text(words, advice, review.arguments));
    ImGui::PopTextWrapPos();
    ImGui::End();
    return action;
}

}  // namespace bolt::trainer
