// The colours that mean something, and the signs that say the same without any: nobody has to tell red from
// green.
#pragma once

#include <glm/vec4.hpp>
#include <span>
#include <string_view>

#include "content/trainee/settings.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/scene.hpp"
#include "engine/text/fonts.hpp"
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

// Labels that would lie over each other in a picture are moved apart.

// Of `on_screen` labels, as seen by `eye` in a picture of that size: pixels from the upper left corner, y
// down, with the margin of a plate. Nothing behind the eye.
struct LabelBox {
    glm::vec2 low{0.0F}, high{0.0F};
    bool seen = false;
    bool names_seen = false;  // what it stands at is in the picture
};
LabelBox box_of(const text::Fonts& fonts, const render::Label& label, const render::Eye& eye,
                const glm::vec2& picture);

// Sets `moved_px` so that no two of them overlap, none is cut off by the picture's edge if what it stands at
// is not, and none lies under what is `taken` (px from the upper left corner), as far as there is room: each
// to the free place that is nearest to its own, the one furthest down first.
void move_apart(const text::Fonts& fonts, std::span<render::Label> labels, const render::Eye& eye,
                const glm::vec2& picture, std::span<const render::Rectangle> taken = {});

}  // namespace bolt::view
