// How a lesson ended, as pictures: every view of the assembly, with a line around each joint in the colour of
// its verdict.
#pragma once

#include "content/format/assembly.hpp"
#include "game/lesson/result.hpp"
#include "game/view/stage.hpp"

namespace bolt::view {

// Green: OK. Amber: LOW. Red: HIGH, or no longer sound. None: not judged.
glm::vec4 verdict_color(const lesson::JointResult& joint);

// Writes FOLDER/view-NAME.png for each view. Nothing for an assembly without a model or without views.
Status draw_result(const content::Assembly& assembly, const lesson::LessonResult& result,
                   const std::filesystem::path& folder, VkExtent2D size);

}  // namespace bolt::view
