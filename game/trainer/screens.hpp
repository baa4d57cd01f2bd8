// The screens that consist of buttons: menu, pause and result. Each function draws one screen with Dear
// ImGui, between ui::Ui::begin and end, and returns the action that the user selects; App carries it out.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/words/words.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainer/lesson_start.hpp"
#include "game/trainer/preferences.hpp"

namespace bolt::trainer {

enum class ScreenAction : std::uint8_t {
    none,
    start_lesson,
    resume,
    undo_step,     // begins the previous step again
    restart_step,  // begins the due step again
    end_lesson,
    show_menu,
    open_settings,
    close_settings,
    select_trainee,  // LessonChoice::trainee was edited
    quit,
};

// Where a control was drawn, so that tests can click on it.
struct ButtonPlace {
    words::TextKey label;
    glm::vec2 middle{0.0F};  // px
    float width = 0.0F;      // px
};

// The drawing context that all screens share.
struct ScreenContext {
    const words::Words& words;
    std::span<const words::Words> languages;
    glm::dvec2 size;  // px, of the picture
    float scale;      // px per point

    std::vector<ButtonPlace>& places;               // receives every control that is drawn
    std::optional<std::string>& selected_language;  // receives the language that the user selects
};

// An assembly in the menu.
struct AssemblyEntry {
    std::string name, default_variant;
    std::map<std::string, std::string> title, lesson;  // by language
    std::vector<content::AssemblyVariant> variants;
    std::vector<content::Tool> tools;
    joint::Law law = joint::Law::mechanistic;
};

// All assemblies under content/ that load and have a model.
std::vector<AssemblyEntry> list_assemblies();

struct Menu {
    std::vector<AssemblyEntry> assemblies;
    std::vector<DeviceOption> devices;
    std::optional<Error> start_error;  // why the last lesson could not start
};

// The menu edits `choice`, and the law and language in `preferences`.
ScreenAction draw_menu(const ScreenContext& context, const Menu& menu, LessonChoice& choice,
                       Preferences& preferences);
ScreenAction draw_pause(const ScreenContext& context, const Preferences& preferences, lesson::Mode mode);
// `has_menu`: offers the way back to the menu.
ScreenAction draw_result(const ScreenContext& context, const content::Assembly& assembly,
                         const lesson::LessonResult& result, bool has_menu);

// Widgets that the settings screen uses as well.

// A button across the window. Returns true when it is pressed.
bool draw_button(const ScreenContext& context, words::TextKey key);
// Stores the place of the control that was drawn last.
void record_place(const ScreenContext& context, words::TextKey key);
void draw_text(const std::string& line);
void draw_wrapped(const std::string& line, const glm::vec4& color);
inline constexpr glm::vec4 muted_text{0.75F, 0.8F, 0.85F, 1.0F};  // for explanations
void draw_languages(const ScreenContext& context, content::TraineeSettings& settings);
// Where the settings are saved, or why they are not.
void draw_settings_file(const ScreenContext& context, const Preferences& preferences);
// Begins a window of this width (px) in the middle of the picture; close it with ImGui::End().
void begin_panel(const ScreenContext& context, const char* name, float width, float opacity);

}  // namespace bolt::trainer
