// Overlay: flat triangles, plain or textured, that are drawn over a picture. Positions are pixels from the
// picture's upper left corner. The user interface and insets are overlays.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/gpu/resources.hpp"
#include "engine/render/passes/pass.hpp"

namespace bolt::render {

struct OverlayVertex {
    glm::vec2 at{0.0F};      // pixels
    glm::vec2 uv{0.0F};      // 0 … 1 from the texture's upper left corner
    std::uint32_t rgba = 0;  // bytes in this order; sRGB, straight alpha
};

struct OverlayTexture {
    ImageLayer picture;                                // its image must have an array view (ImageInfo::array)
    gpu::ResourceUse use = gpu::ResourceUse::sampled;  // the image's use before and after drawing
    bool coverage = false;  // the first channel is coverage; otherwise the texture holds colours
};

struct OverlayDraw {
    VkRect2D scissor{};
    int texture = -1;  // index into the overlay's textures; -1: plain colour
    std::uint32_t first_index = 0, count = 0;
    std::int32_t first_vertex = 0;
};

struct Overlay {
    std::vector<OverlayVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<OverlayDraw> draws;  // in drawing order
    std::vector<OverlayTexture> textures;
};

// In pixels; use whole numbers for sharp edges.
struct Rectangle {
    glm::vec2 low{0.0F}, high{0.0F};
};

// Appends a rectangle of one colour (sRGB, straight alpha).
void add_rectangle(Overlay& overlay, const Rectangle& rectangle, const glm::vec4& color);

// Appends a whole picture of the renderer, stretched to the rectangle. The picture is in
// ResourceUse::transfer_from.
void add_picture(Overlay& overlay, const Rectangle& rectangle, const ImageLayer& picture);

// Appends a picture with a border of this width around it.
void add_inset(Overlay& overlay, const Rectangle& rectangle, const ImageLayer& picture, float border_px,
               const glm::vec4& border);

}  // namespace bolt::render
