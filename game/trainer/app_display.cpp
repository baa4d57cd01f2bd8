// The part of App that changes between window, headset and walls, if the plan of a study names displays.
#include "game/trainer/app.hpp"

namespace bolt::trainer {

namespace {

std::string_view name_of(LessonDisplay::Kind kind) {
    switch (kind) {
        case LessonDisplay::Kind::headset:
            return "in the headset";
        case LessonDisplay::Kind::walls:
            return "on the walls";
        case LessonDisplay::Kind::window:
            break;
    }
    return "in the window";
}

}  // namespace

// A headset that the due lesson of a study needs. The lesson must not go on without it.
bool App::needs_headset() const { return study_ && display_.kind == LessonDisplay::Kind::headset; }

// From the window to the display of the due step, or back to the window.
void App::request_display() {
    const bool in_window = display_.kind == LessonDisplay::Kind::window;
    wanted_display_ = in_window ? study_->due_display() : LessonDisplay{};
}

void App::enter_display(const Status& opened) {
    display_ = opened ? *wanted_display_ : LessonDisplay{};
    wanted_display_.reset();
    room_.reset();
    missing_headset_ = {};
    if (!opened) {
        study_->show_error(opened.error());
        log(opened.error().message());
    }
    log(std::string("the study is shown ") + std::string(name_of(display_.kind)));
}

// A participant who takes the headset off after its last lesson reads the next page in the window.
void App::follow_study_display() {
    if (!needs_headset() || screen_ != ShownScreen::study || wanted_display_) return;
    const bool worn = room_ && room_->seen;
    if (!worn && study_->due_display() != display_) request_display();
}

}  // namespace bolt::trainer
