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

// True while a study is shown in the headset. Without the headset its lesson must not continue.
bool App::shown_in_headset() const { return study_ && display_.kind == LessonDisplay::Kind::headset; }

// Requests the display of the due step, or, from another display, the window.
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

// After a lesson the participant takes the headset off. Unless the next step is done in it, the window then
// shows the next page.
void App::follow_study_display() {
    if (!shown_in_headset() || screen_ != ShownScreen::study || wanted_display_) return;
    const bool worn = room_ && room_->seen;
    if (!worn && study_->due_display() != display_) request_display();
}

}  // namespace bolt::trainer
