#include "game/trainer/menu_choices.hpp"

#include <imgui/imgui.h>

#include <algorithm>
#include <array>

#include "game/lesson/feedback.hpp"

namespace bolt::trainer {

namespace {

constexpr float label_gap = 16.0F;  // points

// px, of the longest label of a row and the gap after it.
float label_width(const ScreenContext& context) {
    float longest = 0.0F;
    for (const words::TextKey label :
         {words::TextKey("menu.task"), words::TextKey("menu.mode"), words::TextKey("menu.variant"),
          words::TextKey("menu.tool"), words::TextKey("menu.law"), words::TextKey("menu.device"),
          words::TextKey("menu.trainee")})
        longest = std::max(longest, ImGui::CalcTextSize(context.words[label].c_str()).x);
    return longest + label_gap * context.scale;
}

// A label with buttons beside it, of which one is chosen. Buttons that do not fit go into another line.
class ChoiceButtons {
  public:
    // `width`: px, of label and buttons.
    ChoiceButtons(const ScreenContext& context, const std::string& label, float width)
        : left_(ImGui::GetCursorPosX() + label_width(context)), right_(ImGui::GetCursorPosX() + width) {
        ImGui::AlignTextToFramePadding();
        ImGui::PushStyleColor(ImGuiCol_Text, {muted_text.r, muted_text.g, muted_text.b, 1.0F});
        draw_text(label);
        ImGui::PopStyleColor();
        ImGui::SameLine();
        ImGui::SetCursorPosX(left_);
    }

    // Returns true when it is pressed.
    bool button(const std::string& label, bool is_chosen) {
        const ImGuiStyle& style = ImGui::GetStyle();
        const float wide = ImGui::CalcTextSize(label.c_str()).x + 2.0F * style.FramePadding.x;
        if (!first_) {
            ImGui::SameLine(0.0F, 0.5F * style.ItemSpacing.x);
            if (ImGui::GetCursorPosX() + wide > right_) {
                ImGui::NewLine();
                ImGui::SetCursorPosX(left_);
            }
        }
        first_ = false;
        ImGui::PushID(row_);  // two rows may have buttons of the same name
        const bool pressed = draw_choice_button(label, is_chosen);
        ImGui::PopID();
        return pressed;
    }

  private:
    int row_ = static_cast<int>(ImGui::GetCursorPosY());
    float left_, right_;  // px in the window
    bool first_ = true;
};

void text_field(const char* id, float width, std::string& value) {
    std::array<char, 64> buffer{};
    value.copy(buffer.data(), buffer.size() - 1);
    ImGui::SetNextItemWidth(width);
    if (ImGui::InputText(id, buffer.data(), buffer.size())) value = buffer.data();
}

void draw_task_and_mode(const ScreenContext& context, float width, LessonChoice& choice) {
    const words::Words& words = context.words;
    ChoiceButtons tasks(context, words["menu.task"], width);
    for (const lesson::Task task : {lesson::Task::tighten, lesson::Task::loosen}) {
        if (tasks.button(words[lesson::text_key(task)], choice.task == task)) choice.task = task;
        note_widget(context, lesson::text_key(task));
    }
    ChoiceButtons modes(context, words["menu.mode"], width);
    for (const lesson::Mode mode : {lesson::Mode::guided, lesson::Mode::practice, lesson::Mode::assessment}) {
        if (modes.button(words[lesson::text_key(mode)], choice.mode == mode)) choice.mode = mode;
        note_widget(context, lesson::text_key(mode));
    }
    const words::TextKey about = choice.mode == lesson::Mode::guided ? words::TextKey("mode.guided.about")
                                 : choice.mode == lesson::Mode::practice
                                     ? words::TextKey("mode.practice.about")
                                     : words::TextKey("mode.assessment.about");
    ImGui::Indent(label_width(context));
    draw_wrapped(words[about], muted_text, width - label_width(context));
    ImGui::Unindent(label_width(context));
}

// A selection replaces the law of the command line and is saved with the trainee's settings.
void draw_laws(const ScreenContext& context, float width, joint::Law assembly_law, LessonChoice& choice,
               content::TraineeSettings& settings) {
    const joint::Law selected = effective_law(choice, settings, assembly_law);
    ChoiceButtons row(context, context.words["menu.law"], width);
    for (const auto& [key, law] : {std::pair{words::TextKey("menu.law.mechanistic"), joint::Law::mechanistic},
                                   std::pair{words::TextKey("menu.law.published"), joint::Law::published}}) {
        if (row.button(context.words[key], selected == law)) {
            settings.law = joint::name(law);
            choice.law.reset();
        }
        note_widget(context, key);
    }
    ImGui::Indent(label_width(context));
    draw_wrapped(
        context.words[selected == joint::Law::mechanistic ? words::TextKey("menu.law.mechanistic.about")
                                                          : words::TextKey("menu.law.published.about")],
        muted_text, width - label_width(context));
    ImGui::Unindent(label_width(context));
}

// Keeps the chosen tool if it is one of these; otherwise the first one is chosen, or that of the station.
void keep_tool(const std::vector<content::Tool>& tools, LessonChoice& choice) {
    const bool known = std::any_of(tools.begin(), tools.end(),
                                   [&](const content::Tool& tool) { return tool.name == choice.tool; });
    if (!known) choice.tool = tool_of_station(choice.equipment.station, tools).value_or(std::string());
}

void draw_variants_and_tools(const ScreenContext& context, float width, const AssemblyEntry& entry,
                             LessonChoice& choice) {
    const std::string& language = context.words.language;
    if (entry.variants.size() > 1) {
        ChoiceButtons row(context, context.words["menu.variant"], width);
        for (const VariantEntry& listed : entry.variants) {
            const content::AssemblyVariant& variant = listed.variant;
            const std::string value = variant.name == entry.default_variant ? std::string() : variant.name;
            if (row.button(in_language(variant.title, language, variant.name), choice.variant == value) &&
                choice.variant != value) {
                choice.variant = value;
                keep_tool(listed.tools, choice);
            }
        }
    }
    const std::vector<content::Tool>& tools = variant_of(entry, choice.variant).tools;
    if (tools.size() > 1) {
        ChoiceButtons row(context, context.words["menu.tool"], width);
        for (const content::Tool& tool : tools) {
            const std::string value = tool.name == tools.front().name ? std::string() : tool.name;
            if (row.button(in_language(tool.title, language, tool.name), choice.tool == value))
                choice.tool = value;
        }
    }
}

// The name of a hand that no device moves.
words::TextKey hand_key(HandMode hand) {
    if (hand == HandMode::free) return "menu.free_hand";
    return hand == HandMode::tracked ? words::TextKey("menu.tracked_hand") : "menu.mouse";
}

void draw_devices(const ScreenContext& context, float width, std::span<const DeviceOption> devices,
                  Equipment& equipment) {
    ChoiceButtons row(context, context.words["menu.device"], width);
    for (const DeviceOption& option : devices) {
        const std::string name =
            option.name.empty() ? context.words[hand_key(option.equipment.hand)] : option.name;
        Equipment next = option.equipment;
        next.station = equipment.station;
        next.wheel_config_file = equipment.wheel_config_file;
        next.glove = equipment.glove;
        if (row.button(name, equipment.devices == next.devices && equipment.hand == next.hand))
            equipment = next;
    }
}

// The field for a name or a code, with the code of the person whom it means beside it.
ScreenAction draw_trainee(const ScreenContext& context, float width, const SelectedTrainee& trainee,
                          LessonChoice& choice) {
    const content::IdentifiedPerson& identified = trainee.identified;
    const std::string& code = identified.person.code;
    const std::string shown_code =
        words::format_text(context.words, "menu.trainee.code", {{"code", code.empty() ? "T-000000" : code}});
    const float beside = ImGui::CalcTextSize(shown_code.c_str()).x + 8.0F * context.scale;
    ChoiceButtons row(context, context.words["menu.trainee"], width);
    text_field("##trainee", width - label_width(context) - beside, choice.trainee);
    note_widget(context, "menu.trainee");
    const bool entered = ImGui::IsItemDeactivatedAfterEdit();
    if (!code.empty() && choice.trainee == trainee.text) {
        ImGui::SameLine();
        ImGui::AlignTextToFramePadding();
        draw_wrapped(shown_code, muted_text, beside);
        note_widget(context, "menu.trainee.code");
        if (identified.names_error)
            draw_wrapped(words::format_text(context.words, "menu.trainee.no_names",
                                            {{"why", identified.names_error->message()}, {"code", code}}),
                         warning_text, width);
        if (!identified.similar_code.empty())
            draw_wrapped(words::format_text(context.words, "menu.trainee.similar",
                                            {{"code", code}, {"other", identified.similar_code}}),
                         warning_text, width);
    }
    return entered ? ScreenAction::select_trainee : ScreenAction::none;
}

// Names each model that the lesson lacks, and says that no device with forces is connected.
void draw_missing(const ScreenContext& context, float width, const ChoiceOptions& options,
                  const LessonChoice& choice) {
    const AssemblyEntry& entry = *options.entry;
    std::vector<std::string> missing;
    if (!entry.error && !entry.contact_model) missing.push_back(context.words["menu.missing.contact"]);
    for (const std::string& line : missing) draw_wrapped(line, warning_text, width);
    const bool connected = std::any_of(options.devices.begin(), options.devices.end(),
                                       [](const DeviceOption& o) { return !o.equipment.devices.empty(); });
    if (!connected && choice.equipment.hand == HandMode::helped)
        draw_wrapped(context.words["menu.missing.force"], muted_text, width);
}

}  // namespace

void choose_assembly(const AssemblyEntry& entry, LessonChoice& choice) {
    if (entry.name == choice.assembly) return;
    choice.assembly = entry.name;
    choice.variant.clear();
    choice.tool =
        tool_of_station(choice.equipment.station, entry.variants.front().tools).value_or(std::string());
}

ScreenAction draw_choices(const ScreenContext& context, float width, const ChoiceOptions& options,
                          LessonChoice& choice, Preferences& preferences) {
    const AssemblyEntry* entry = options.entry;
    draw_task_and_mode(context, width, choice);
    if (entry != nullptr) {
        draw_variants_and_tools(context, width, *entry, choice);
        draw_laws(context, width, entry->law, choice, preferences.settings);
    }
    draw_devices(context, width, options.devices, choice.equipment);
    const ScreenAction action = draw_trainee(context, width, options.trainee, choice);
    ImGui::Spacing();
    if (entry != nullptr) draw_missing(context, width, options, choice);
    if (preferences.file_error != Preferences::FileError::none) draw_settings_file(context, preferences);
    return action;
}

}  // namespace bolt::trainer
