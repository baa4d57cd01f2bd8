#include "game/trainer/menu.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>

#include <algorithm>

namespace bolt::trainer {

namespace {

// Lengths in points.
constexpr float column_width = 480.0F, menu_margin = 24.0F;
constexpr float card_width = 176.0F, thumbnail_height = 92.0F, card_padding = 6.0F;
// Below this size the menu is one column that scrolls.
constexpr float min_wide_width = 940.0F, min_wide_height = 690.0F;

const ImVec4 primary{0.13F, 0.55F, 0.36F, 1.0F}, primary_hovered{0.16F, 0.64F, 0.42F, 1.0F};
constexpr ImU32 column_color = IM_COL32(20, 24, 29, 244), strip_color = IM_COL32(20, 24, 29, 226),
                picture_frame = IM_COL32(110, 190, 240, 255), no_picture = IM_COL32(40, 46, 54, 255);

constexpr ImGuiWindowFlags menu_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBackground;

bool is_wide(const glm::vec2& size, float scale) {
    return size.x >= min_wide_width * scale && size.y >= min_wide_height * scale;
}

float wrapped_height(const std::string& text, float width) {
    return ImGui::CalcTextSize(text.c_str(), text.c_str() + text.size(), false, width).y;
}

const AssemblyEntry* selected_entry(const Menu& menu, const LessonChoice& choice) {
    const auto entry =
        std::find_if(menu.assemblies.begin(), menu.assemblies.end(),
                     [&](const AssemblyEntry& candidate) { return candidate.name == choice.assembly; });
    return entry == menu.assemblies.end() ? nullptr : &*entry;
}

// The reason why no lesson can start, or why the last one did not; empty if there is none.
std::string start_problem(const Menu& menu, const AssemblyEntry* entry) {
    if (entry != nullptr && entry->error) return entry->error->message();
    return menu.start_error ? menu.start_error->message() : std::string();
}

bool draw_wide_button(const ScreenContext& context, words::TextKey key, const ImVec2& size, bool is_primary) {
    if (is_primary) {
        ImGui::PushStyleColor(ImGuiCol_Button, primary);
        ImGui::PushStyleColor(ImGuiCol_ButtonHovered, primary_hovered);
    }
    const bool pressed = ImGui::Button(context.words[key].c_str(), size);
    if (is_primary) ImGui::PopStyleColor(2);
    note_widget(context, key);
    return pressed;
}

// Start and tour; the first one is drawn larger and gets the keyboard's focus.
ScreenAction draw_start(const ScreenContext& context, float width, const Menu& menu,
                        const LessonChoice& choice) {
    ScreenAction action = ScreenAction::none;
    const float line = ImGui::GetFrameHeight();
    const AssemblyEntry* entry = selected_entry(menu, choice);
    if (menu.first_start) draw_wrapped(context.words["menu.tour.about"], muted_text, width);
    for (const bool tour : {menu.first_start, !menu.first_start}) {
        const bool first = tour == menu.first_start;
        const bool disabled = !tour && entry != nullptr && entry->error.has_value();
        if (disabled) ImGui::BeginDisabled();
        if (draw_wide_button(context, tour ? words::TextKey("menu.tour") : words::TextKey("menu.start"),
                             {width, first ? 1.5F * line : line}, first))
            action = tour ? ScreenAction::start_tour : ScreenAction::start_lesson;
        if (disabled) ImGui::EndDisabled();
        if (first) ImGui::SetItemDefaultFocus();
    }
    return action;
}

// The buttons share the width in proportion to their texts.
ScreenAction draw_pages(const ScreenContext& context, float width) {
    struct Page {
        words::TextKey key;
        ScreenAction opens;
    };
    constexpr Page pages[] = {{"menu.settings", ScreenAction::open_settings},
                              {"menu.computer", ScreenAction::show_computer},
                              {"menu.files", ScreenAction::show_files},
                              {"menu.quit", ScreenAction::quit}};
    ScreenAction action = ScreenAction::none;
    const float gap = 0.5F * ImGui::GetStyle().ItemSpacing.x;
    float texts = 0.0F;
    for (const auto& [key, opens] : pages) texts += ImGui::CalcTextSize(context.words[key].c_str()).x;
    const float padding = (width - texts) / static_cast<float>(std::size(pages)) - gap;
    for (const auto& [key, opens] : pages) {
        if (opens != pages[0].opens) ImGui::SameLine(0.0F, gap);
        const float text = ImGui::CalcTextSize(context.words[key].c_str()).x;
        if (draw_wide_button(context, key, {text + padding, 0.0F}, false)) action = opens;
    }
    return action;
}

// A card with picture and title. Returns true when it is pressed.
bool draw_card(const ScreenContext& context, const AssemblyEntry& entry, bool is_selected,
               const MenuPictures& pictures) {
    const float scale = context.scale, padding = card_padding * scale, line = ImGui::GetTextLineHeight();
    const std::string title = in_language(entry.title, context.words.language, entry.name);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size(card_width * scale, thumbnail_height * scale + 2.0F * line + 3.0F * padding);
    ImGui::PushID(entry.name.c_str());
    const bool pressed = ImGui::Selectable("##card", is_selected, 0, size);
    ImGui::PopID();
    note_widget(context, "menu.assemblies");
    context.drawn_widgets.back().assembly = entry.name;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 low(at.x + padding, at.y + padding),
        high(at.x + size.x - padding, at.y + padding + thumbnail_height * scale);
    const auto picture = pictures.thumbnails.find(entry.name);
    if (picture != pictures.thumbnails.end())
        list.AddImageRounded(picture->second, low, high, {0, 0}, {1, 1}, IM_COL32_WHITE, 4.0F * scale);
    else
        list.AddRectFilled(low, high, no_picture, 4.0F * scale);
    if (is_selected) list.AddRect(low, high, picture_frame, 4.0F * scale, 0, 2.0F * scale);
    const ImVec4 clip(low.x, high.y, high.x, high.y + padding + 2.0F * line);
    list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), {low.x, high.y + padding},
                 ImGui::GetColorU32(entry.error ? ImGuiCol_TextDisabled : ImGuiCol_Text), title.c_str(),
                 title.c_str() + title.size(), high.x - low.x, &clip);
    return pressed;
}

// One line of cards around the selected one; arrows select the next assembly where not all fit.
void draw_cards(const ScreenContext& context, float width, const Menu& menu, const MenuPictures& pictures,
                LessonChoice& choice) {
    const float gap = ImGui::GetStyle().ItemSpacing.x, card = card_width * context.scale;
    const auto count = static_cast<int>(menu.assemblies.size());
    const float arrow = ImGui::GetFrameHeight();
    const auto fitting = [&](float room) {
        return std::max(1, static_cast<int>((room + gap) / (card + gap)));
    };
    const bool all = count <= fitting(width);
    const int shown = all ? count : fitting(width - 2.0F * (arrow + gap));
    const AssemblyEntry* entry = selected_entry(menu, choice);
    // −1: an assembly that the menu does not list, from the command line.
    const int selected = entry == nullptr ? -1 : static_cast<int>(entry - menu.assemblies.data());
    const int first = std::clamp(selected - shown / 2, 0, count - shown);
    const auto step = [&](const char* label, int by) {
        if (ImGui::Button(label, {arrow, 0.0F}))
            choose_assembly(
                menu.assemblies[static_cast<std::size_t>(std::clamp(selected + by, 0, count - 1))], choice);
    };
    if (!all) {
        step("‹", -1);
        ImGui::SameLine();
    }
    for (int i = first; i < first + shown; ++i) {
        const AssemblyEntry& listed = menu.assemblies[static_cast<std::size_t>(i)];
        if (i > first) ImGui::SameLine();
        if (draw_card(context, listed, i == selected, pictures)) choose_assembly(listed, choice);
    }
    if (!all) {
        ImGui::SameLine();
        step("›", 1);
    }
}

void draw_title(const ScreenContext& context, const std::string& title) {
    ImGui::PushFont(context.heading);
    draw_text(title);
    ImGui::PopFont();
}

void draw_description(const ScreenContext& context, float width, const AssemblyEntry& entry,
                      const VariantEntry& variant) {
    draw_title(context, in_language(entry.title, context.words.language, entry.name));
    if (variant.joints > 0) draw_wrapped(joints_text(context.words, variant), muted_text, width);
    draw_wrapped(in_language(variant.lesson_texts, context.words.language, ""), {0.93F, 0.94F, 0.95F, 1.0F},
                 width);
}

// The languages as buttons whose right end is at `right` px.
void draw_language_buttons(const ScreenContext& context, float right, content::TraineeSettings& settings) {
    const ImGuiStyle& style = ImGui::GetStyle();
    float width = 0.0F;
    for (const words::Words& language : context.languages)
        width += ImGui::CalcTextSize(language.name.c_str()).x + 2.0F * style.FramePadding.x +
                 0.5F * style.ItemSpacing.x;
    ImGui::SetCursorPosX(right - width);
    for (const words::Words& language : context.languages) {
        const bool current = language.language == context.words.language;
        if (draw_choice_button(language.name, current))
            context.selected_language = settings.language = language.language;
        ImGui::SameLine(0.0F, 0.5F * style.ItemSpacing.x);
    }
    ImGui::NewLine();
}

ScreenAction first_of(ScreenAction a, ScreenAction b) { return a != ScreenAction::none ? a : b; }

struct WideMenu {
    ScreenAction action = ScreenAction::none;
    bool fits = true;  // false: the picture is not high enough
};

// The choices on the left; the assembly, its description and the cards on the right.
WideMenu draw_wide(const ScreenContext& context, Menu& menu, const MenuPictures& pictures,
                   LessonChoice& choice, Preferences& preferences) {
    const float scale = context.scale, edge = menu_margin * scale, column = column_width * scale;
    const ImVec2 size(static_cast<float>(context.size.x), static_cast<float>(context.size.y));
    const float inner = column - 2.0F * edge, right_width = size.x - column - 2.0F * edge;
    const AssemblyEntry* entry = selected_entry(menu, choice);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({0.0F, 0.0F}, {column, size.y}, column_color);

    ImGui::SetCursorPos({edge, edge});
    ImGui::BeginGroup();
    draw_title(context, "Boltwright");
    draw_wrapped(context.words["menu.tagline"], muted_text, inner);
    ImGui::Dummy({0.0F, 0.5F * edge});
    ScreenAction action =
        draw_choices(context, inner, {entry, menu.devices, menu.trainee}, choice, preferences);
    const float spacing = ImGui::GetStyle().ItemSpacing.y;
    const float actions =
        3.5F * ImGui::GetFrameHeight() + 3.0F * spacing +
        (menu.first_start ? wrapped_height(context.words["menu.tour.about"], inner) + spacing : 0.0F);
    bool fits = ImGui::GetCursorPosY() <= size.y - edge - actions;
    ImGui::SetCursorPosY(std::max(ImGui::GetCursorPosY(), size.y - edge - actions));
    action = first_of(action, draw_start(context, inner, menu, choice));
    action = first_of(action, draw_pages(context, inner));
    ImGui::EndGroup();

    ImGui::SetCursorPosY(edge);
    draw_language_buttons(context, size.x - edge, preferences.settings);

    const float card =
        thumbnail_height * scale + 2.0F * ImGui::GetTextLineHeight() + 3.0F * card_padding * scale;
    float height = card + 2.0F * edge + 2.0F * spacing;
    if (entry != nullptr)
        height += wrapped_height(in_language(variant_of(*entry, choice.variant).lesson_texts,
                                             context.words.language, ""),
                                 right_width) +
                  ImGui::GetTextLineHeight() + context.heading->FontSize + 2.0F * spacing;
    const std::string problem = start_problem(menu, entry);
    if (!problem.empty()) height += wrapped_height(problem, right_width) + spacing;
    fits = fits && height < size.y - edge - ImGui::GetFrameHeight();
    list.AddRectFilled({column, size.y - height}, size, strip_color);
    menu.covered = {column, height};
    ImGui::SetCursorPos({column + edge, size.y - height + edge});
    ImGui::BeginGroup();
    if (!problem.empty()) draw_wrapped(problem, warning_text, right_width);
    if (entry != nullptr) draw_description(context, right_width, *entry, variant_of(*entry, choice.variant));
    ImGui::SetCursorPosY(size.y - edge - card);
    draw_cards(context, right_width, menu, pictures, choice);
    ImGui::EndGroup();
    return {action, fits};
}

// Everything in one column that scrolls, with the buttons at the top.
ScreenAction draw_narrow(const ScreenContext& context, const Menu& menu, const MenuPictures& pictures,
                         LessonChoice& choice, Preferences& preferences) {
    const float edge = 0.5F * menu_margin * context.scale;
    const float width = ImGui::GetWindowContentRegionMax().x - 2.0F * edge;
    ImGui::SetCursorPos({edge, edge});
    ImGui::BeginGroup();
    draw_title(context, "Boltwright");
    ImGui::SameLine();
    draw_language_buttons(context, edge + width, preferences.settings);
    ScreenAction action = draw_start(context, width, menu, choice);
    action = first_of(action, draw_pages(context, width));
    const std::string problem = start_problem(menu, selected_entry(menu, choice));
    if (!problem.empty()) draw_wrapped(problem, warning_text, width);
    draw_cards(context, width, menu, pictures, choice);
    const AssemblyEntry* entry = selected_entry(menu, choice);
    action = first_of(action,
                      draw_choices(context, width, {entry, menu.devices, menu.trainee}, choice, preferences));
    if (entry != nullptr) {
        ImGui::Separator();
        draw_description(context, width, *entry, variant_of(*entry, choice.variant));
    }
    ImGui::EndGroup();
    return action;
}

}  // namespace

void add_constant_characters(ui::Ui& ui, const Menu& menu) {
    for (const AssemblyEntry& entry : menu.assemblies) add_characters(ui, entry);
    for (const auto& folder : {menu.folders.sessions, menu.folders.settings, menu.folders.assemblies})
        ui.add_characters(folder.string());
}

void add_changing_characters(ui::Ui& ui, const words::Words& words, const Menu& menu,
                             const LessonChoice& choice) {
    ui.add_characters(choice.trainee);
    const auto& names_error = menu.trainee.identified.names_error;
    if (names_error) ui.add_characters(names_error->message());
    for (const DeviceOption& option : menu.devices) ui.add_characters(option.name);
    for (const computer::Finding& finding : menu.check.findings())
        ui.add_characters(words::format_text(words, finding.text, finding.arguments));
    if (menu.start_error) ui.add_characters(menu.start_error->message());
}

AssemblyPictures::Request picture_request(const Menu& menu, const std::string& selected, VkExtent2D size,
                                          float scale) {
    AssemblyPictures::Request request;
    request.selected = selected;
    for (const AssemblyEntry& entry : menu.assemblies)
        if (!entry.error) request.listed.push_back(entry.name);
    request.size = size;
    request.thumbnail = {static_cast<std::uint32_t>((card_width - 2.0F * card_padding) * scale),
                         static_cast<std::uint32_t>(thumbnail_height * scale)};
    const glm::vec2 extent(static_cast<float>(size.width), static_cast<float>(size.height));
    request.shift = menu.covered / extent;
    return request;
}

ScreenAction draw_menu(const ScreenContext& context, Menu& menu, const MenuPictures& pictures,
                       LessonChoice& choice, Preferences& preferences) {
    if (menu.page == MenuPage::computer) {
        menu.check.update();
        return draw_computer_page(context, menu.check);
    }
    if (menu.page == MenuPage::files) return draw_files_page(context, menu.folders);
    const glm::vec2 size(context.size);
    const std::string layout = fmt::format("{} {} {} {}x{} {}", choice.assembly, choice.variant,
                                           context.words.language, size.x, size.y, context.scale);
    const bool wide = is_wide(size, context.scale) && menu.single_column_for != layout;
    ImGui::SetNextWindowPos({0.0F, 0.0F});
    ImGui::SetNextWindowSize({size.x, size.y});
    ImGui::SetNextWindowBgAlpha(0.94F);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0.0F, 0.0F});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0F);
    ImGui::Begin(
        "##menu", nullptr,
        wide ? menu_flags : menu_flags & ~(ImGuiWindowFlags_NoBackground | ImGuiWindowFlags_NoScrollbar));
    ImGui::PopStyleVar(2);
    menu.covered = {};
    const WideMenu drawn = wide ? draw_wide(context, menu, pictures, choice, preferences)
                                : WideMenu{draw_narrow(context, menu, pictures, choice, preferences), true};
    ImGui::End();
    if (!drawn.fits) menu.single_column_for = layout;
    return drawn.action;
}

}  // namespace bolt::trainer
