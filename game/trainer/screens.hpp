// Types that all screens of buttons share, and the screens of a lesson: pause and result. menu.hpp has the
// menu. Each function draws one screen with Dear ImGui, between ui::Ui::begin and end, and returns the action
// that the user selects; App carries it out.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/words/words.hpp"
#include "game/lesson/result.hpp"
#include "game/trainer/preferences.hpp"

namespace bolt::trainer {

enum class ScreenAction : std::uint8_t {
    none,
    start_lesson,
    start_tour,
    pause,
    resume,
    undo_step,     // begins the previous step again
    restart_step,  // begins the due step again
    end_lesson,
    show_menu,
    open_settings,
    close_settings,
    show_computer,  // the page of the menu about this computer
    show_files,     // the page of the menu about the user's files
    close_page,
    permit_move,  // the arm may move by itself
    cancel_start,
    end_touch_check,  // skips it, or starts the lesson after its result
    place_again,      // panel and workpiece of a room, in front of the user
    turn_left,        // this and the next three move the workpiece of a room by a step
    turn_right,
    raise,
    lower,
    second_wrench,   // puts it on the held or due joint, or takes it away
    select_trainee,  // LessonChoice::trainee was edited
    change_display,  // to the one that the due step of a study needs
    quit,
};

// Where a widget was drawn, so that tests can click on it.
struct DrawnWidget {
    words::TextKey label;
    glm::vec2 middle{0.0F};  // px
    float width = 0.0F;      // px
    std::string assembly;    // name, of a card of the menu
};

// The drawing context that all screens share.
struct ScreenContext {
    const words::Words& words;
    std::span<const words::Words> languages;
    glm::dvec2 size;  // px, of the picture
    float scale;      // px per point
    ImFont* heading;  // a larger font

    std::vector<DrawnWidget>& drawn_widgets;        // receives every widget that is drawn
    std::optional<std::string>& selected_language;  // receives the language that the user selects
};

// Optional parts of the screen of a pause.
struct PauseOptions {
    bool headset_lost = false;  // the screen says so, and that the user can go on with the mouse
    bool in_room = false;  // offers to place panel and workpiece again, and to turn and raise the workpiece
};
ScreenAction draw_pause(const ScreenContext& context, const Preferences& preferences, lesson::Mode mode,
                        const PauseOptions& options);
struct ResultOptions {
    bool menu = false;   // offers the way back to the menu
    bool tour = false;   // the lesson was the tour
    bool study = false;  // the lesson is part of a study, whose next page follows
};
ScreenAction draw_result(const ScreenContext& context, const content::Assembly& assembly,
                         const lesson::LessonResult& result, const ResultOptions& options);

// Widgets that the menu and the settings screen use as well.

// A button as wide as the dialog. Returns true when it is pressed.
bool draw_button(const ScreenContext& context, words::TextKey key);
// Adds the widget that was drawn last to `drawn_widgets`.
void note_widget(const ScreenContext& context, words::TextKey key);
void draw_text(const std::string& line);
// `width`: px, at which the text wraps; 0: the rest of the dialog.
void draw_wrapped(const std::string& line, const glm::vec4& color, float width = 0.0F);
// A button in a row of alternatives. Returns true when it is pressed.
bool draw_choice_button(const std::string& label, bool is_chosen);
inline constexpr glm::vec4 muted_text{0.75F, 0.8F, 0.85F, 1.0F};    // for explanations
inline constexpr glm::vec4 warning_text{1.0F, 0.55F, 0.45F, 1.0F};  // for what is wrong or missing
void draw_languages(const ScreenContext& context, content::TraineeSettings& settings);
// Where the settings are saved, or why they are not.
void draw_settings_file(const ScreenContext& context, const Preferences& preferences);
// Begins a dialog of this width (px) in the middle of the picture; close it with ImGui::End().
void begin_dialog(const ScreenContext& context, const char* name, float width, float opacity);
// The same at the right edge, where it leaves the scene visible.
void begin_dialog_at_right(const ScreenContext& context, const char* name, float width, float opacity);

}  // namespace bolt::trainer
