#include "game/trainer/lesson_starter.hpp"

#include <utility>

namespace bolt::trainer {

LessonStarter::LessonStarter(LessonStart start, std::unique_ptr<LessonStarter> before)
    : before_(std::move(before)) {
    start.arm_dialog.permission = permission_;
    start.arm_dialog.on_preparation = [this](const device::Preparation& preparation) {
        return show(preparation);
    };
    thread_ = std::jthread([this, begun = std::move(start)] {
        before_.reset();
        result_.emplace(given_up_ ? fail(ErrorCode::failed, "the start was cancelled") : start_lesson(begun));
        done_ = true;
    });
}

LessonStarter::~LessonStarter() { give_up(); }

bool LessonStarter::show(const device::Preparation& preparation) {
    const std::lock_guard lock(mutex_);
    preparation_ = preparation;
    return !given_up_;
}

std::optional<Result<StartedLesson>> LessonStarter::take() {
    if (!done_ || !result_) return {};
    return std::exchange(result_, std::nullopt);
}

device::ArmNeeds LessonStarter::needs() const {
    const std::lock_guard lock(mutex_);
    return {preparation_, permission_->active()};
}

void LessonStarter::permit_move() { permission_->grant(); }
void LessonStarter::give_up() { given_up_ = true; }

}  // namespace bolt::trainer
