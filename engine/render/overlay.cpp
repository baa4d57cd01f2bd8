#include "engine/render/overlay.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/packing.hpp>

namespace bolt::render {

namespace {

void add(Overlay& overlay, const Rectangle& rectangle, const glm::vec4& color, int texture) {
    const auto first = static_cast<std::uint32_t>(overlay.vertices.size());
    const std::uint32_t rgba = glm::packUnorm4x8(color);
    for (const glm::vec2& corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(0, 1), glm::vec2(1, 1)})
        overlay.vertices.push_back({rectangle.low + corner * (rectangle.high - rectangle.low), corner, rgba});
    OverlayDraw draw;
    const glm::vec2 low = glm::max(glm::floor(rectangle.low), 0.0F),
                    high = glm::max(glm::ceil(rectangle.high), low);
    draw.scissor.offset = {static_cast<std::int32_t>(low.x), static_cast<std::int32_t>(low.y)};
    draw.scissor.extent = {static_cast<std::uint32_t>(high.x - low.x),
                           static_cast<std::uint32_t>(high.y - low.y)};
    draw.texture = texture;
    draw.first_index = static_cast<std::uint32_t>(overlay.indices.size());
    draw.count = 6;
    for (const std::uint32_t corner : {0U, 1U, 2U, 2U, 1U, 3U}) overlay.indices.push_back(first + corner);
    overlay.draws.push_back(draw);
}

}  // namespace

void add_rectangle(Overlay& overlay, const Rectangle& rectangle, const glm::vec4& color) {
    add(overlay, rectangle, color, -1);
}

void add_picture(Overlay& overlay, const Rectangle& rectangle, const ImageLayer& picture) {
    overlay.textures.push_back({picture, gpu::ResourceUse::transfer_from, false});
    add(overlay, rectangle, glm::vec4(1.0F), static_cast<int>(overlay.textures.size()) - 1);
}

void add_inset(Overlay& overlay, const Rectangle& rectangle, const ImageLayer& picture, float border_px,
               const glm::vec4& border) {
    add_rectangle(overlay, {rectangle.low - border_px, rectangle.high + border_px}, border);
    add_picture(overlay, rectangle, picture);
}

}  // namespace bolt::render
