// What lies flat over a picture: triangles in pixels from its upper left corner, coloured, or with a texture
// on them. The user interface is drawn from it, and pictures of other views.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "engine/gpu/barrier.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

struct OverlayVertex {
    glm::vec2 at{0.0F};      // pixels
    glm::vec2 uv{0.0F};      // 0 … 1 from the texture's upper left corner
    std::uint32_t rgba = 0;  // bytes in this order; sRGB, alpha not multiplied in
};

struct OverlayTexture {
    Layer picture;                     // of an image that is an array
    gpu::Use use = gpu::Use::sampled;  // in which it is, and is again afterwards
    bool coverage = false;             // its first channel says how much is covered; else colours
};

struct OverlayDraw {
    VkRect2D scissor{};
    int texture = -1;  // of the overlay; −1: none, just the colour
    std::uint32_t first_index = 0, count = 0;
    std::int32_t first_vertex = 0;
};

struct Overlay {
    std::vector<OverlayVertex> vertices;
    std::vector<std::uint32_t> indices;
    std::vector<OverlayDraw> draws;  // later ones over earlier ones
    std::vector<OverlayTexture> textures;
};

// Pixels; whole ones for sharp edges.
struct Rectangle {
    glm::vec2 low{0.0F}, high{0.0F};
};

void add_rectangle(Overlay& overlay, const Rectangle& place, const glm::vec4& color);

// A picture of the renderer's, all of it; texel for pixel where the place has its size.
void add_picture(Overlay& overlay, const Rectangle& place, const Layer& picture);

// A picture in the picture, with a frame of this width around it.
void add_inset(Overlay& overlay, const Rectangle& place, const Layer& picture, float frame_px,
               const glm::vec4& frame_color);

}  // namespace bolt::render
