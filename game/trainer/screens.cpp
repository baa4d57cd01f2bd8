#include "game/trainer/screens.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <array>

#include "game/lesson/feedback.hpp"
#include "game/view/labels.hpp"

namespace bolt::trainer {

namespace {

constexpr ImGuiWindowFlags panel_flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                         ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar;
constexpr glm::vec4 warning{1.0F, 0.55F, 0.45F, 1.0F};

ImVec4 to_imgui(const glm::vec4& color) { return {color.r, color.g, color.b, color.a}; }

// The text in `language`, else in English, else `fallback`.
std::string in_language(const std::map<std::string, std::string>& texts, const std::string& language,
                        const std::string& fallback) {
    for (const std::string& code : {language, std::string("en")})
        if (const auto found = texts.find(code); found != texts.end()) return found->second;
    return fallback;
}

template <class Value>
void radio_button(const char* label, Value& value, Value option) {
    if (ImGui::RadioButton(label, value == option)) value = option;
    ImGui::SameLine();
}

void text_field(const char* label, std::string& value) {
    std::array<char, 64> buffer{};
    value.copy(buffer.data(), buffer.size() - 1);
    if (ImGui::InputText(label, buffer.data(), buffer.size())) value = buffer.data();
}

// Shown only if there is more than the mouse to choose.
void draw_devices(const ScreenContext& context, std::span<const DeviceOption> devices, Equipment& equipment) {
    if (devices.size() < 2) return;
    for (const DeviceOption& option : devices) {
        const std::string name = option.name.empty() ? context.words["menu.mouse"] : option.name;
        Equipment next = option.equipment;
        next.wheel_config_file = equipment.wheel_config_file;
        next.glove = equipment.glove;
        if (ImGui::RadioButton(name.c_str(), equipment.devices == next.devices && !equipment.keyboard))
            equipment = next;
    }
}

// A selection replaces the law of the command line and is saved with the trainee's settings.
void draw_laws(const ScreenContext& context, joint::Law assembly_law, LessonChoice& choice,
               content::TraineeSettings& settings) {
    ImGui::AlignTextToFramePadding();
    draw_text(context.words["menu.law"]);
    const joint::Law selected = law_in_force(choice, settings, assembly_law);
    for (const auto& [key, law] : {std::pair{words::TextKey("menu.law.mechanistic"), joint::Law::mechanistic},
                                   std::pair{words::TextKey("menu.law.published"), joint::Law::published}}) {
        ImGui::SameLine();
        if (ImGui::RadioButton(context.words[key].c_str(), selected == law)) {
            settings.law = joint::name(law);
            choice.law.reset();
        }
        record_place(context, key);
    }
}

void draw_variants_and_tools(const std::string& language, const AssemblyEntry& entry, LessonChoice& choice) {
    if (entry.variants.size() > 1) {
        for (const content::AssemblyVariant& variant : entry.variants)
            radio_button(in_language(variant.title, language, variant.name).c_str(), choice.variant,
                         variant.name == entry.default_variant ? std::string() : variant.name);
        ImGui::NewLine();
    }
    if (entry.tools.size() > 1) {
        for (const content::Tool& tool : entry.tools)
            radio_button(in_language(tool.title, language, tool.name).c_str(), choice.tool,
                         tool.name == entry.tools.front().name ? std::string() : tool.name);
        ImGui::NewLine();
    }
}

// Draws the list of assemblies and, for the selected one, its variants, tools and lesson. Returns that entry;
// null if the choice is not in the list.
const AssemblyEntry* draw_assemblies(const ScreenContext& context, const Menu& menu, LessonChoice& choice) {
    const std::string& language = context.words.language;
    for (const AssemblyEntry& entry : menu.assemblies) {
        const bool selected = entry.name == choice.assembly;
        if (ImGui::Selectable(in_language(entry.title, language, entry.name).c_str(), selected) &&
            !selected) {
            choice.assembly = entry.name;
            choice.variant.clear();
            choice.tool.clear();
        }
    }
    ImGui::Separator();
    const auto entry =
        std::find_if(menu.assemblies.begin(), menu.assemblies.end(),
                     [&](const AssemblyEntry& candidate) { return candidate.name == choice.assembly; });
    if (entry == menu.assemblies.end()) return nullptr;
    draw_variants_and_tools(language, *entry, choice);
    ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(muted_text));
    ImGui::BeginChild("##lesson", {0.0F, 150.0F * context.scale});
    ImGui::PushTextWrapPos(0.0F);
    draw_text(in_language(entry->lesson, language, ""));
    ImGui::PopTextWrapPos();
    ImGui::EndChild();
    ImGui::PopStyleColor();
    return &*entry;
}

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

std::vector<AssemblyEntry> list_assemblies() {
    std::vector<std::string> names;
    std::error_code problem;
    const auto folder = content::content_folder() / "assemblies";
    for (auto entry = std::filesystem::directory_iterator(folder, problem);
         !problem && entry != std::filesystem::directory_iterator(); entry.increment(problem))
        if (std::filesystem::exists(entry->path() / "assembly.json"))
            names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    std::vector<AssemblyEntry> entries;
    for (const std::string& name : names) {
        const content::LoadedAssembly loaded = content::load_assembly(name);
        if (!loaded.ok() || loaded.assembly.models.model.empty()) continue;
        entries.push_back({name, loaded.assembly.variant, loaded.assembly.title, loaded.assembly.lesson,
                           loaded.assembly.variants, loaded.assembly.tools, loaded.assembly.law});
    }
    return entries;
}

void record_place(const ScreenContext& context, words::TextKey key) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    context.places.push_back({key, {0.5F * (low.x + high.x), 0.5F * (low.y + high.y)}, high.x - low.x});
}

bool draw_button(const ScreenContext& context, words::TextKey key) {
    const bool pressed = ImGui::Button(context.words[key].c_str(), {-1.0F, 0.0F});
    record_place(context, key);
    return pressed;
}

void draw_text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

void draw_wrapped(const std::string& line, const glm::vec4& color) {
    ImGui::PushStyleColor(ImGuiCol_Text, to_imgui(color));
    ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopStyleColor();
}

void begin_panel(const ScreenContext& context, const char* name, float width, float opacity) {
    ImGui::SetNextWindowPos(
        {static_cast<float>(0.5 * context.size.x), static_cast<float>(0.5 * context.size.y)},
        ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, static_cast<float>(context.size.y)});
    ImGui::SetNextWindowBgAlpha(opacity);
    ImGui::Begin(name, nullptr, panel_flags);
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
    switch (preferences.trouble) {
        case Preferences::Trouble::read_failed:
            return draw_wrapped(
                words::format_text(context.words, "settings.unread", {{"why", preferences.trouble_message}}),
                warning);
        case Preferences::Trouble::write_failed:
            return draw_wrapped(words::format_text(context.words, "settings.unwritten",
                                                   {{"why", preferences.trouble_message}}),
                                warning);
        case Preferences::Trouble::none:
            break;
    }
    if (settings_file(preferences).empty())
        draw_wrapped(context.words["settings.not_kept"], muted_text);
    else if (!preferences.trainee.empty())
        draw_wrapped(words::format_text(context.words, "settings.kept", {{"trainee", preferences.trainee}}),
                     muted_text);
}

ScreenAction draw_menu(const ScreenContext& context, const Menu& menu, LessonChoice& choice,
                       Preferences& preferences) {
    const words::Words& words = context.words;
    ScreenAction action = ScreenAction::none;
    begin_panel(context, "##menu", 560.0F * context.scale, 0.94F);
    draw_text("Boltwright");
    ImGui::Separator();
    const AssemblyEntry* entry = draw_assemblies(context, menu, choice);
    for (const lesson::Mode mode : {lesson::Mode::guided, lesson::Mode::practice, lesson::Mode::assessment})
        radio_button(words[lesson::text_key(mode)].c_str(), choice.mode, mode);
    ImGui::NewLine();
    for (const lesson::Task task : {lesson::Task::tighten, lesson::Task::loosen})
        radio_button(words[lesson::text_key(task)].c_str(), choice.task, task);
    ImGui::NewLine();
    if (entry != nullptr) draw_laws(context, entry->law, choice, preferences.settings);
    draw_devices(context, menu.devices, choice.equipment);
    text_field(words["menu.trainee"].c_str(), choice.trainee);
    if (ImGui::IsItemDeactivatedAfterEdit()) action = ScreenAction::select_trainee;
    draw_languages(context, preferences.settings);
    ImGui::Separator();
    if (menu.start_error) draw_wrapped(menu.start_error->message(), warning);
    if (preferences.trouble != Preferences::Trouble::none) draw_settings_file(context, preferences);
    if (draw_button(context, "menu.start")) action = ScreenAction::start_lesson;
    ImGui::SetItemDefaultFocus();
    if (draw_button(context, "menu.settings")) action = ScreenAction::open_settings;
    if (draw_button(context, "menu.quit")) action = ScreenAction::quit;
    ImGui::End();
    return action;
}

ScreenAction draw_pause(const ScreenContext& context, const Preferences& preferences, lesson::Mode mode) {
    ScreenAction action = ScreenAction::none;
    begin_panel(context, "##pause", 300.0F * context.scale, 0.94F);
    draw_text(context.words["menu.paused"]);
    ImGui::Separator();
    if (preferences.trouble != Preferences::Trouble::none) draw_settings_file(context, preferences);
    if (draw_button(context, "menu.go_on")) action = ScreenAction::resume;
    if (mode != lesson::Mode::assessment) {
        if (draw_button(context, "menu.undo")) action = ScreenAction::undo_step;
        if (draw_button(context, "menu.restart_step")) action = ScreenAction::restart_step;
    }
    if (draw_button(context, "menu.settings")) action = ScreenAction::open_settings;
    if (draw_button(context, "menu.end")) action = ScreenAction::end_lesson;
    if (draw_button(context, "menu.quit")) action = ScreenAction::quit;
    ImGui::End();
    return action;
}

ScreenAction draw_result(const ScreenContext& context, const content::Assembly& assembly,
                         const lesson::LessonResult& result, bool has_menu) {
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
    if (draw_button(context, "menu.again")) action = ScreenAction::start_lesson;
    if (has_menu && draw_button(context, "menu.menu")) action = ScreenAction::show_menu;
    if (draw_button(context, "menu.quit")) action = ScreenAction::quit;
    ImGui::Separator();
    draw_joint_table(words, result.joints);
    const lesson::Review review = lesson::review(assembly, result);
    ImGui::PushTextWrapPos(340.0F * scale);
    for (const lesson::Remark& reason : review.reasons)
        draw_text((reason.points != 0.0 ? fmt::format("{:+.0f}  ", reason.points) : std::string()) +
                  lesson::remark_text(words, reason));
    ImGui::Separator();
    for (const words::TextKey advice : review.advice) draw_text(words[advice]);
    ImGui::PopTextWrapPos();
    ImGui::End();
    return action;
}

}  // namespace bolt::trainer
