// Colours and symbols of states and verdicts, and the layout of labels without overlaps. Each colour has a
// symbol with the same meaning, so that colour vision is not needed.
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
    glm::vec4 due{1.0F, 0.78F, 0.1F, 1.0F};   // the next task and the path to it
    glm::vec4 low{1.0F, 0.7F, 0.05F, 1.0F};   // below its tolerance
    glm::vec4 ok{0.1F, 0.8F, 0.25F, 1.0F};    // within its tolerance
    glm::vec4 high{0.95F, 0.1F, 0.1F, 1.0F};  // above its tolerance, or damaged
    // Text on a dark plate: the present torque is within the tolerance, or above it.
    glm::vec4 ok_text{0.45F, 0.95F, 0.5F, 1.0F};
    glm::vec4 high_text{1.0F, 0.35F, 0.3F, 1.0F};
};

// The colours of the palette `distinct` also differ for an eye without red or green cones
// (tests/view/palette.cpp).
Palette palette_of(content::PaletteKind kind);

// The verdict on a joint; a damaged joint counts as high.
lesson::Verdict verdict_of(const lesson::JointResult& joint);
// Alpha 0 for no verdict.
glm::vec4 color_of(const Palette& palette, lesson::Verdict verdict);

// "▼" for low, "●" for ok, "▲" for high; empty for no verdict.
std::string_view symbol_of(lesson::Verdict verdict);
inline constexpr std::string_view due_symbol = "◆";

// The plate of a label on the screen, in pixels from the upper left corner, y down.
struct LabelBox {
    glm::vec2 low{0.0F}, high{0.0F};
    bool visible = false;            // false: the anchor is behind the eye
    bool anchor_in_picture = false;  // the point that the label annotates is in the picture
};

// The box of a label of placement on_screen, seen from `eye` in a picture of that size.
LabelBox box_of(const text::Fonts& fonts, const render::Label& label, const render::Eye& eye,
                const glm::vec2& picture);

// Changes `offset_px` of the labels of placement on_screen. Beginning with the lowest, moves each label to
// the nearest place where it overlaps no label placed before and no rectangle of `occupied` (px). A label
// whose anchor is in the picture is placed wholly in it. Where there is no room, labels may overlap.
void separate_labels(const text::Fonts& fonts, std::span<render::Label> labels, const render::Eye& eye,
                     const glm::vec2& picture, std::span<const render::Rectangle> occupied = {});

}  // namespace bolt::view
