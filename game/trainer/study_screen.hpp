// The pages that lead a participant through a study: information, consent, questionnaires, breaks, and the
// start of each lesson. Every answer is stored when it is given (study::Participation). The pages never show
// the name of a condition.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "game/study/participation.hpp"
#include "game/trainer/screens.hpp"

namespace bolt::trainer {

// A study that the program leads a participant through.
struct StudyRun {
    study::Participation participation;
    std::filesystem::path folder;     // of the study
    std::function<void()> on_step{};  // called when another step is due
};

// The display that shows a lesson of a study.
struct LessonDisplay {
    enum class Kind : std::uint8_t { window, headset, walls } kind = Kind::window;
    std::string file;  // of walls: the display file
    bool operator==(const LessonDisplay&) const = default;
};

class StudyScreen {
  public:
    explicit StudyScreen(StudyRun run)
        : participation_(std::move(run.participation)),
          folder_(std::move(run.folder)),
          on_step_(std::move(run.on_step)) {}

    // Draws the page of the due step on the display that shows it now. If the due step needs another display,
    // draws a page that leads there instead. Returns start_lesson, change_display, quit or none.
    ScreenAction draw(const ScreenContext& context, const LessonDisplay& shown);
    // The display of the due lesson. For other pages, or if the plan names no displays: the window.
    [[nodiscard]] LessonDisplay due_display() const;

    [[nodiscard]] study::Participation& participation() { return participation_; }
    [[nodiscard]] const study::Participation& participation() const { return participation_; }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    // All texts that the pages can show, for the characters of the font.
    [[nodiscard]] std::string texts() const;
    // Shows on the page that something could not be stored, until something is stored.
    void show_error(const Error& error) { error_ = error; }

  private:
    enum class StopDialog : std::uint8_t { closed, choice, withdrawal, withdrawn };

    // The buttons below a page.
    struct PageButtons {
        words::TextKey forward;
        bool enabled = true, back = false;
    };
    enum class Pressed : std::uint8_t { none, forward, back };
    Pressed draw_buttons(const ScreenContext& context, const PageButtons& buttons);

    ScreenAction draw_step(const ScreenContext& context, const study::Step& step);
    void draw_language(const ScreenContext& context);
    void draw_information(const ScreenContext& context);
    void draw_consent(const ScreenContext& context);
    void draw_form(const ScreenContext& context, const content::Questionnaire& form);
    void draw_item(const ScreenContext& context, const content::Questionnaire& form);
    ScreenAction draw_lesson(const ScreenContext& context, const study::Step& step);
    ScreenAction draw_display(const ScreenContext& context, const LessonDisplay& shown);
    void draw_break(const ScreenContext& context);
    void draw_comment(const ScreenContext& context);
    ScreenAction draw_last_pages(const ScreenContext& context, const study::Step& step);
    ScreenAction draw_stop_dialog(const ScreenContext& context);
    // Completes the due step; a failure is shown on the page.
    void complete();
    bool store(const Status& stored);

    study::Participation participation_;
    std::filesystem::path folder_;
    std::function<void()> on_step_;
    std::string shown_step_;  // id
    std::size_t item_ = 0;    // of the form that is shown
    std::string comment_;
    StopDialog stop_ = StopDialog::closed;
    std::optional<Error> error_;
};

}  // namespace bolt::trainer
