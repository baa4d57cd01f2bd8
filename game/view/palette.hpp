// The colours that mean something, and the signs that say the same without any: nobody has to tell red from
// green.
#pragma once

#include <glm/vec4.hpp>
#include <string_view>

#include "content/trainee/settings.hpp"
#include "game/lesson/result.hpp"

namespace bolt::view {

struct Palette {
    glm::vec4 due{1.0F, 0.78F, 0.1F, 1.0F};     // what is to be done, and the way there
    glm::vec4 low{1.0F, 0.7F, 0.05F, 1.0F};     // below its window
    glm::vec4 ok{0.1F, 0.8F, 0.25F, 1.0F};      // inside
    glm::vec4 high{0.95F, 0.1F, 0.1F, 1.0F};    // above, or damaged
    glm::vec4 right{0.45F, 0.95F, 0.5F, 1.0F};  // the same of what is being worked at, as text on a plate
    glm::vec4 wrong{1.0F, 0.35F, 0.3F, 1.0F};
};

// The distinct one also with no red or green cones (tests/view/palette.cpp).
Palette palette_of(content::PaletteKind kind);

// What became of a joint; without alpha: nothing.
lesson::Verdict verdict_of(const lesson::JointResult& joint);
glm::vec4 color_of(const Palette& palette, lesson::Verdict verdict);

// "▼", "●", "▲", in this order: below, inside, above. Empty for nothing.
std::string_view sign_of(lesson::Verdict verdict);
inline constexpr std::string_view due_sign = "◆";

}  // namespace bolt::view
