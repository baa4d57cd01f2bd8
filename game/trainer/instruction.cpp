#include "game/trainer/instruction.hpp"

#include <algorithm>

#include "game/trainer/assembly_entry.hpp"

namespace bolt::trainer {

namespace {

constexpr float instruction_width = 420.0F;    // points
constexpr float largest_picture_share = 0.5F;  // of the height of the picture on screen
constexpr glm::vec4 instruction_color{0.95F, 0.96F, 0.97F, 1.0F};

const content::Instruction& instruction_of(const lesson::Lesson& lesson, const lesson::LessonStep& step) {
    const auto pass = static_cast<std::size_t>(step.pass);
    const content::Assembly& assembly = *lesson.assembly;
    static const content::Instruction none;
    const auto& passes = lesson.task == lesson::Task::tighten ? assembly.passes : assembly.loosening;
    return pass < passes.size() ? passes[pass].instruction : none;
}

}  // namespace

bool update(InstructionState& state, const lesson::Lesson& lesson, bool paused) {
    if (paused) return false;
    state.shown = nullptr;
    const lesson::LessonStep* due = lesson.due();
    if (due == nullptr || due->pass <= state.latest_pass) return false;
    state.latest_pass = due->pass;
    const content::Instruction& instruction = instruction_of(lesson, *due);
    if (instruction.text.empty()) return false;
    state.shown = &instruction;
    return true;
}

ScreenAction draw_instruction(const ScreenContext& context, const content::Instruction& instruction,
                              const InstructionPicture* picture) {
    const float width =
        std::min(instruction_width * context.scale, 0.5F * static_cast<float>(context.size.x));
    begin_dialog_at_right(context, "##instruction", width, 0.94F);
    if (picture != nullptr) {
        const float room = ImGui::GetContentRegionAvail().x,
                    highest = largest_picture_share * static_cast<float>(context.size.y);
        const float zoom = std::min(room / picture->size.x, highest / picture->size.y);
        const glm::vec2 size = zoom * picture->size;
        ImGui::SetCursorPosX(ImGui::GetCursorPosX() + 0.5F * (room - size.x));
        ImGui::Image(picture->texture, {size.x, size.y});
    }
    draw_wrapped(in_language(instruction.text, context.words.language, ""), instruction_color);
    ImGui::Separator();
    const bool pressed = draw_button(context, "menu.go_on");
    ImGui::End();
    return pressed ? ScreenAction::resume : ScreenAction::none;
}

}  // namespace bolt::trainer
