// A second view in a corner of the picture: picture-in-picture, or the trainee's view in the instructor's.
#pragma once

#include "engine/render/renderer.hpp"

namespace bolt::render {

struct Inset {
    Eye eye;
    Rectangle place;  // of whole pixels; the view is drawn in this size
    float frame_px = 2.0F;
    glm::vec4 frame{0.92F, 0.94F, 0.96F, 1.0F};  // its colour, as the overlay has colours
};

// In the lower right corner, as wide as this share of the picture, and of its shape.
Rectangle lower_right(VkExtent2D picture, float share);

// Records the views, and each inset over all of them. The insets' own pictures are the renderer's groups from
// 1 on.
Status render_with_insets(Renderer& renderer, gpu::Frame& frame, const Scene& scene,
                          std::span<const Eye> eyes, VkExtent2D extent, std::span<const Inset> insets);

}  // namespace bolt::render
