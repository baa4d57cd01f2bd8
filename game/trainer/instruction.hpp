// The author's instruction at the beginning of a pass: a page with text and picture. The lesson is paused
// until the trainee goes on.
#pragma once

#include <imgui/imgui.h>

#include "game/lesson/lesson.hpp"
#include "game/trainer/screens.hpp"

namespace bolt::trainer {

struct InstructionState {
    int latest_pass = -1;                         // the latest pass that has begun
    const content::Instruction* shown = nullptr;  // of the lesson's assembly; null: no page
};

// Call it once a frame. Returns true in the frame in which a page appears: the caller pauses the lesson. The
// page goes when the lesson is no longer paused. A lesson that is paused for another reason, such as the
// touch check of an arm, shows its page after that. Undoing steps does not show a page again.
bool update(InstructionState& state, const lesson::Lesson& lesson, bool paused);

struct InstructionPicture {
    ImTextureID texture{};
    glm::vec2 size{0.0F};  // px of the file
};

// `picture`: null if there is none.
ScreenAction draw_instruction(const ScreenContext& context, const content::Instruction& instruction,
                              const InstructionPicture* picture);

}  // namespace bolt::trainer
