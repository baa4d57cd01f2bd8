#include "game/trainer/arm_screen.hpp"

#include <imgui/imgui.h>

namespace bolt::trainer {

namespace {

bool asks(const device::ArmNeeds& needs) {
    return needs.preparation.need == device::DeviceNeed::permission && !needs.moves;
}

std::string request_of(const words::Words& words, const ArmScreen& screen) {
    const device::ArmNeeds& needs = screen.needs;
    if (needs.moves) return words["arm.moves"];
    switch (needs.preparation.need) {
        case device::DeviceNeed::permission:
            return words["arm.permission"];
        case device::DeviceNeed::inkwell:
            return words["arm.inkwell"];
        case device::DeviceNeed::user:
            return words::format_text(words, "arm.user", {{"text", needs.preparation.instruction}});
        case device::DeviceNeed::wait:
            return words["arm.calibrates"];
        case device::DeviceNeed::none:
            break;
    }
    return words[screen.restores ? words::TextKey("study.restoring") : "arm.starting"];
}

std::string keys_of(const words::Words& words, const ArmScreen& screen) {
    const std::string enter(platform::name(platform::Key::enter));
    const std::string escape(platform::name(platform::Key::escape));
    if (screen.in_lesson) return words::format_text(words, "arm.key", {{"start", enter}});
    return words::format_text(words, "arm.keys", {{"start", enter}, {"back", escape}});
}

}  // namespace

void update(ArmScreen& screen, const device::ArmNeeds& needs, double seconds) {
    const bool same = needs.preparation == screen.needs.preparation && needs.moves == screen.needs.moves;
    screen.shown_for = same ? screen.shown_for + seconds : 0.0;
    screen.needs = needs;
}

ScreenAction action_of(const ArmScreen& screen, std::span<const platform::InputEvent> events,
                       bool enter_key_answers) {
    const bool takes_answer = asks(screen.needs) && screen.shown_for >= question_time;
    for (const platform::InputEvent& event : events) {
        const bool answers = enter_key_answers || !std::holds_alternative<platform::KeyEvent>(event);
        if (is_confirmation(event) && takes_answer && answers) return ScreenAction::permit_move;
        if (is_back(event) && !screen.in_lesson) return ScreenAction::cancel_start;
    }
    return ScreenAction::none;
}

ScreenAction draw_arm(const ScreenContext& context, const ArmScreen& screen) {
    ScreenAction action = ScreenAction::none;
    begin_dialog(context, "##arm", 420.0F * context.scale, 0.94F);
    const bool warns = screen.needs.moves || asks(screen.needs);
    draw_wrapped(request_of(context.words, screen), warns ? warning_text : muted_text);
    ImGui::Separator();
    if (asks(screen.needs)) {
        draw_wrapped(keys_of(context.words, screen), muted_text);
        ImGui::BeginDisabled(screen.shown_for < question_time);
        if (draw_button(context, "arm.move")) action = ScreenAction::permit_move;
        ImGui::EndDisabled();
    }
    if (screen.in_lesson) {
        if (draw_button(context, "menu.end")) action = ScreenAction::end_lesson;
        if (draw_button(context, "menu.quit")) action = ScreenAction::quit;
    } else if (draw_button(context, "menu.back")) {
        action = ScreenAction::cancel_start;
    }
    ImGui::End();
    return action;
}

void pause_for_arm(StationClient& client, LessonClock& clock) {
    if (client.needs.any()) {
        if (!client.waits_for_arm) client.user_had_paused = clock.paused;
        client.waits_for_arm = clock.paused = true;
    } else if (client.waits_for_arm) {
        client.waits_for_arm = false;
        clock.paused = client.user_had_paused;
    }
}

std::optional<words::TextKey> arm_warning(const device::DeviceHealth& health) {
    if (health.cooling) return words::TextKey("arm.rests");
    if (device::is_warm(health)) return words::TextKey("arm.warm");
    return {};
}

std::string describe(const device::ArmNeeds& needs) {
    if (needs.moves) return "the arm may move by itself";
    switch (needs.preparation.need) {
        case device::DeviceNeed::permission:
            return "the arm asks whether it may move by itself";
        case device::DeviceNeed::inkwell:
            return "the arm needs its inkwell";
        case device::DeviceNeed::user:
            return "the arm waits for the user: " + needs.preparation.instruction;
        case device::DeviceNeed::wait:
            return "the arm calibrates itself";
        case device::DeviceNeed::none:
            break;
    }
    return {};
}

}  // namespace bolt::trainer
