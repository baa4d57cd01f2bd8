#include "engine/render/inset.hpp"

#include <cmath>

namespace bolt::render {

Rectangle lower_right(VkExtent2D picture, float share) {
    const glm::vec2 size(picture.width, picture.height);
    const glm::vec2 inset = glm::max(glm::round(size * share), 1.0F);
    const glm::vec2 high = size - std::round(0.025F * size.y);
    return {high - inset, high};
}

Status render_with_insets(Renderer& renderer, gpu::Frame& frame, const Scene& scene,
                          std::span<const Eye> eyes, VkExtent2D extent, std::span<const Inset> insets) {
    if (Status drawn = renderer.render(frame, scene, eyes, extent); !drawn) return drawn;
    Overlay overlay;
    for (std::uint32_t i = 0; i < insets.size(); ++i) {
        const Inset& inset = insets[i];
        const glm::vec2 size = inset.place.high - inset.place.low;
        const VkExtent2D own{static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)};
        if (Status drawn = renderer.render(frame, scene, {&inset.eye, 1}, own, i + 1); !drawn) return drawn;
        add_inset(overlay, inset.place, renderer.picture(0, i + 1), inset.frame_px, inset.frame);
    }
    for (std::uint32_t view = 0; view < eyes.size(); ++view)
        if (Status over = renderer.draw_over(frame, overlay, renderer.picture(view)); !over) return over;
    return {};
}

}  // namespace bolt::render
