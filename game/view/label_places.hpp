// Labels that would lie over each other in a picture are moved apart.
#pragma once

#include <span>

#include "engine/render/label.hpp"
#include "engine/render/overlay.hpp"
#include "engine/render/scene.hpp"
#include "engine/text/fonts.hpp"

namespace bolt::view {

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
