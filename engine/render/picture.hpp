// Offscreen rendering into pictures on the CPU, and pictures with insets.
#pragma once

#include "engine/render/renderer.hpp"

namespace bolt::render {

// A second view in a corner of the picture, such as the trainee's view in the instructor's picture.
struct Inset {
    Eye eye;
    Rectangle place;  // in whole pixels; the view is rendered at this size
    float frame_px = 2.0F;
    glm::vec4 frame{0.92F, 0.94F, 0.96F, 1.0F};  // colour, encoded as overlay colours
};

// Returns a rectangle in the lower right corner: `share` of the picture's width, with the picture's aspect
// ratio.
Rectangle inset_rectangle(VkExtent2D picture, float share);

// Renders the views, and draws each inset over all of them. The insets use the renderer's groups from 1 on.
Status render_with_insets(Renderer& renderer, gpu::FrameContext& frame, const Scene& scene,
                          std::span<const Eye> eyes, VkExtent2D extent, std::span<const Inset> insets);

struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // sRGB, rows from the top
};

// Renders one picture per eye.
Result<std::vector<Picture>> take_pictures(gpu::Device& device, gpu::Frames& frames, Renderer& renderer,
                                           const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                                           std::span<const Inset> insets = {});

}  // namespace bolt::render
