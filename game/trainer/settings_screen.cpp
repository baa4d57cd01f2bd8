#include "game/trainer/settings_screen.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <cmath>

namespace bolt::trainer {

namespace {

constexpr double default_seat = 1.2;  // m, height of the eyes
constexpr glm::vec4 highlight{1.0F, 0.85F, 0.4F, 1.0F};

words::TextKey text_key(Action action) {
    constexpr words::TextKey keys[] = {
        "action.tool",          "action.find_view",    "action.whole_view",  "action.hint",
        "action.flange_map",    "action.pause",        "action.full_screen", "action.quiet",
        "action.undo",          "action.restart_step", "action.recentre",    "action.close_up",
        "action.second_wrench", "action.place_again",  "action.turn_left",   "action.turn_right",
        "action.raise",         "action.lower",        "action.mirror"};
    static_assert(std::size(keys) == action_count);
    return keys[static_cast<std::size_t>(action)];
}

struct SliderRange {
    double low = 0.0, high = 1.0;
    const char* format = "%.0f %%";
    double display_factor = 100.0;
};

// Rounds to hundredths: finer than a hand can set, and short in the file.
void draw_slider(const char* label, double& value, const SliderRange& range) {
    auto displayed = static_cast<float>(value * range.display_factor);
    if (ImGui::SliderFloat(label, &displayed, static_cast<float>(range.low * range.display_factor),
                           static_cast<float>(range.high * range.display_factor), range.format,
                           ImGuiSliderFlags_AlwaysClamp))
        value = std::clamp(std::round(100.0 * static_cast<double>(displayed) / range.display_factor) / 100.0,
                           range.low, range.high);
}

}  // namespace

void SettingsScreen::bind_key(platform::Key key, const words::Words& words, KeyMap& keys) {
    const Action action = *waiting_;
    const BindResult bound = bind(keys, action, key);
    const std::string pressed(platform::name(key));
    if (bound.outcome == BindOutcome::refused) {
        message_ = words::format_text(words, "settings.key_refused", {{"key", pressed}});
        return;
    }
    waiting_.reset();
    message_.clear();
    if (bound.outcome == BindOutcome::swapped)
        message_ = words::format_text(words, "settings.key_swapped",
                                      {{"key", pressed},
                                       {"action", words[text_key(bound.other)]},
                                       {"other", key_name(keys, bound.other)}});
}

std::vector<platform::InputEvent> SettingsScreen::take_keys(std::span<const platform::InputEvent> events,
                                                            const words::Words& words, KeyMap& keys,
                                                            bool& closes) {
    std::vector<platform::InputEvent> remaining;
    for (const platform::InputEvent& event : events) {
        const auto* key = std::get_if<platform::KeyEvent>(&event);
        const bool pressed = key != nullptr && key->down && !key->repeated;
        if (closes) {
            remaining.push_back(event);
        } else if (is_back(event)) {
            closes = !waiting_;
            waiting_.reset();
        } else if (waiting_ && pressed) {
            bind_key(key->key, words, keys);
        } else if (!waiting_ || key == nullptr || !key->down) {
            remaining.push_back(event);
        }
    }
    return remaining;
}

void SettingsScreen::draw_person(const ScreenContext& context, content::TraineeSettings& settings,
                                 bool in_study) {
    const words::Words& words = context.words;
    draw_languages(context, settings);
    // Two sliders in a row, so that the dialog is not too high for a small window.
    const auto half_slider = [&](words::TextKey key, double& value, const SliderRange& range) {
        ImGui::SetNextItemWidth(0.34F * ImGui::GetColumnWidth());  // the label needs the rest of the column
        draw_slider(words[key].c_str(), value, range);
        note_widget(context, key);
        ImGui::NextColumn();
    };
    ImGui::Columns(2, "levels", false);
    half_slider("menu.sound", settings.volume, {});
    half_slider("menu.vibration", settings.vibration, {});
    ImGui::Columns(1);
    ImGui::Checkbox(words["menu.captions"].c_str(), &settings.captions);
    note_widget(context, "menu.captions");
    ImGui::AlignTextToFramePadding();
    draw_text(words["menu.palette"]);
    for (const auto& [key, kind] :
         {std::pair{words::TextKey("menu.palette.usual"), content::PaletteKind::usual},
          std::pair{words::TextKey("menu.palette.distinct"), content::PaletteKind::distinct}}) {
        ImGui::SameLine();
        if (ImGui::RadioButton(words[key].c_str(), settings.palette == kind)) settings.palette = kind;
        note_widget(context, key);
    }
    ImGui::Separator();
    ImGui::Columns(2, "body and display", false);
    const auto checkbox = [&](words::TextKey key, bool& value) {
        const bool changed = ImGui::Checkbox(words[key].c_str(), &value);
        note_widget(context, key);
        return changed;
    };
    checkbox("menu.left_handed", settings.left_handed);
    bool seated = settings.seated_eye_height.has_value();
    if (checkbox("menu.seated", seated))
        settings.seated_eye_height = seated ? std::optional(default_seat) : std::nullopt;
    if (!in_study) {
        ImGui::SetNextItemWidth(0.4F * ImGui::GetColumnWidth());  // the label needs the rest of the column
        draw_slider(words["menu.force_scale"].c_str(), settings.force_scale, {content::min_force_scale, 1.0});
        note_widget(context, "menu.force_scale");
    }
    ImGui::NextColumn();
    checkbox("menu.force_arrow", settings.force_arrow);
    checkbox("menu.surroundings", settings.passthrough);
    checkbox("menu.vignette", settings.vignette);
    ImGui::Columns(1);
    ImGui::Columns(2, "sizes", false);
    half_slider("settings.arm_reach", settings.arm_reach,
                {content::min_arm_reach, content::max_arm_reach, "%.2f m", 1.0});
    if (settings.seated_eye_height)
        half_slider("settings.seated_height", *settings.seated_eye_height,
                    {content::min_seated_eye_height, content::max_seated_eye_height, "%.2f m", 1.0});
    ImGui::Columns(1);
}

// The keys of a room are offered only in one. The rows are then closer, so that the dialog is not too high.
void SettingsScreen::draw_keys(const ScreenContext& context, KeyMap& keys, bool in_room) {
    const words::Words& words = context.words;
    draw_text(words["menu.keys"]);
    ImGui::Columns(2, "keys", false);
    const std::size_t shown = in_room ? action_count : static_cast<std::size_t>(Action::place_again);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                        {ImGui::GetStyle().ItemSpacing.x, in_room ? 1.0F : ImGui::GetStyle().ItemSpacing.y});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x,
                                                     in_room ? 1.0F : ImGui::GetStyle().FramePadding.y});
    for (std::size_t i = 0; i < shown; ++i) {
        const auto action = static_cast<Action>(i);
        const bool waits = waiting_ == action;
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Button(waits ? "…" : key_name(keys, action).c_str(), {80.0F * context.scale, 0.0F})) {
            waiting_ = waits ? std::nullopt : std::optional(action);
            message_.clear();
        }
        note_widget(context, text_key(action));
        ImGui::PopID();
        ImGui::SameLine();
        draw_text(words[text_key(action)]);
        if (i + 1 == (shown + 1) / 2) ImGui::NextColumn();
    }
    ImGui::PopStyleVar(2);
    ImGui::Columns(1);
    if (waiting_)
        draw_wrapped(
            words::format_text(words, "settings.press_key", {{"action", words[text_key(*waiting_)]}}),
            highlight);
    if (!message_.empty()) draw_wrapped(message_, highlight);
    draw_wrapped(words["settings.escape"], muted_text);
    if (draw_button(context, "settings.usual_keys")) {
        keys = KeyMap{};
        *this = {};
    }
}

ScreenAction SettingsScreen::draw(const ScreenContext& context, Preferences& preferences,
                                  OpenedIn opened_in) {
    begin_dialog(context, "##settings", 720.0F * context.scale, 0.96F);
    draw_text(context.words["menu.settings"]);
    ImGui::Separator();
    draw_person(context, preferences.settings, opened_in.study);
    if (opened_in.lesson) draw_wrapped(context.words["settings.next_lesson"], muted_text);
    ImGui::Separator();
    draw_keys(context, preferences.keys, opened_in.room);
    ImGui::Separator();
    draw_settings_file(context, preferences);
    const bool back = draw_button(context, "menu.back");
    ImGui::End();
    return back ? ScreenAction::close_settings : ScreenAction::none;
}

}  // namespace bolt::trainer
