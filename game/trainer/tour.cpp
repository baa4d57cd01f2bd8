#include "game/trainer/tour.hpp"

#include <imgui/imgui.h>

#include <algorithm>

#include "game/lesson/fastener_names.hpp"

namespace bolt::trainer {

namespace {

constexpr double enough_turn = 0.25;  // rad, of the view

bool& done(Tour& tour, TourTask task) { return tour.done.at(static_cast<std::size_t>(task)); }

// The control for a motion at the joint of the tour.
std::string control_of(const words::Words& words, const ActiveLesson& active,
                       const lesson::ControlNames& controls, lesson::HintMotion motion) {
    const words::TextArgument thread =
        lesson::thread_argument(active.session->assembly().joints.front().design);
    return words::replace_placeholders(words, controls.at(static_cast<std::size_t>(motion)), {&thread, 1});
}

// The angle by which a drag of this frame turns the view, rad; the speed is that of view::turn.
double view_drag(const LessonFrame& frame) {
    const FrameInput& input = frame.input;
    glm::dvec2 drag = input.right_drag;
    if (input.left_down && !frame.active.pointer.drags_hand) drag += input.left_drag;
    return pi * glm::length(drag) / frame.size.y;
}

}  // namespace

LessonChoice tour_choice(LessonChoice choice) {
    choice.assembly = content::assembly_folder(tour_assembly).string();
    choice.variant.clear();
    choice.tool.clear();
    choice.mode = lesson::Mode::guided;
    choice.task = lesson::Task::tighten;
    return choice;
}

std::size_t Tour::due_task() const {
    return static_cast<std::size_t>(std::find(done.begin(), done.end(), false) - done.begin());
}

void update(Tour& tour, const LessonFrame& frame) {
    const FrameInput& input = frame.input;
    const lesson::Lesson& lesson = frame.active.session->lesson();
    tour.turned += view_drag(frame);
    const auto tick_off = [&](TourTask task, bool condition) {
        if (condition) done(tour, task) = true;
    };
    tick_off(TourTask::look, tour.turned > enough_turn);
    tick_off(TourTask::zoom, input.scroll != 0.0);
    tick_off(TourTask::find, input.triggered(Action::find_view));
    tick_off(TourTask::run_down, lesson.current > 0);
    tick_off(TourTask::help, input.triggered(Action::hint));
    tick_off(TourTask::pause, tour.paused && !frame.active.clock.paused);
    tick_off(TourTask::take, lesson.current > 0 && hand_of(frame.active).wrench);
    tick_off(TourTask::tighten, lesson.current > 1);
    tour.paused = frame.active.clock.paused;
}

std::string tour_text(const words::Words& words, TourTask task, const ActiveLesson& active,
                      const lesson::ControlNames& controls) {
    using lesson::HintMotion;
    const auto key = [&](Action action) { return key_name(active.input.keys, action); };
    const auto control = [&](HintMotion motion) { return control_of(words, active, controls, motion); };
    switch (task) {
        case TourTask::look:
            return words["tour.look"];
        case TourTask::zoom:
            return words["tour.zoom"];
        case TourTask::find:
            return words::format_text(words, "tour.find", {{"key", key(Action::find_view)}});
        case TourTask::run_down:
            return words::format_text(
                words, "tour.run_down",
                {{"grip", control(HintMotion::grip_nut)}, {"turn", control(HintMotion::spin)}});
        case TourTask::help:
            return words::format_text(words, "tour.help", {{"key", key(Action::hint)}});
        case TourTask::pause:
            return words::format_text(words, "tour.pause", {{"key", key(Action::pause)}});
        case TourTask::take:
            return words::format_text(words, "tour.take", {{"control", control(HintMotion::take)}});
        case TourTask::tighten:
            return words::format_text(
                words, "tour.tighten",
                {{"torque",
                  words::torque_number(active.session->assembly().joints.front().spec.torque.target)},
                 {"set_on", control(HintMotion::set_on)},
                 {"pull", control(HintMotion::pull_on)}});
    }
    return {};
}

void draw_tour(const Tour& tour, const ActiveLesson& active, const HudText& texts, const glm::dvec2& size,
               float scale) {
    const float width = std::min(320.0F * scale, 0.4F * static_cast<float>(size.x));
    ImGui::SetNextWindowPos({12.0F * scale, 0.5F * static_cast<float>(size.y)}, ImGuiCond_Always,
                            {0.0F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, static_cast<float>(size.y)});
    ImGui::SetNextWindowBgAlpha(0.85F);
    ImGui::Begin("##tour", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoInputs |
                     ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                     ImGuiWindowFlags_NoNav | ImGuiWindowFlags_AlwaysAutoResize);
    const std::size_t due = tour.due_task();
    const float indent = 1.6F * ImGui::GetFontSize();
    for (std::size_t i = 0; i < tour_task_count; ++i) {
        const bool is_done = tour.done.at(i);
        const ImVec4 color = is_done    ? ImVec4(0.5F, 0.75F, 0.55F, 1.0F)
                             : i == due ? ImVec4(1.0F, 0.85F, 0.4F, 1.0F)
                                        : ImVec4(0.62F, 0.65F, 0.68F, 1.0F);
        ImGui::PushStyleColor(ImGuiCol_Text, color);
        ImGui::TextUnformatted(is_done ? "✓" : i == due ? "▶" : "·");
        ImGui::SameLine(indent);
        const std::string text = tour_text(*texts.words, static_cast<TourTask>(i), active, *texts.controls);
        ImGui::PushTextWrapPos(width - ImGui::GetStyle().WindowPadding.x);
        ImGui::TextUnformatted(text.c_str(), text.c_str() + text.size());
        ImGui::PopTextWrapPos();
        ImGui::PopStyleColor();
    }
    ImGui::End();
}

}  // namespace bolt::trainer
