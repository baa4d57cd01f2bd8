#include "engine/render/picture.hpp"

#include <cmath>
#include <cstring>

#include "engine/gpu/transfer.hpp"

namespace bolt::render {

Rectangle inset_rectangle(VkExtent2D picture, float share) {
    const glm::vec2 size(picture.width, picture.height);
    const glm::vec2 inset = glm::max(glm::round(size * share), 1.0F);
    const glm::vec2 high = size - std::round(0.025F * size.y);
    return {high - inset, high};
}

Status render_with_insets(Renderer& renderer, gpu::FrameContext& frame, const Scene& scene,
                          std::span<const Eye> eyes, VkExtent2D extent, std::span<const Inset> insets) {
    BOLT_TRY(renderer.render(frame, scene, eyes, extent));
    Overlay overlay;
    for (std::uint32_t i = 0; i < insets.size(); ++i) {
        const Inset& inset = insets[i];
        const glm::vec2 size = inset.place.high - inset.place.low;
        const VkExtent2D inset_extent{static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)};
        BOLT_TRY(renderer.render(frame, scene, {&inset.eye, 1}, inset_extent, i + 1));
        add_inset(overlay, inset.place, renderer.picture(0, i + 1), inset.frame_px, inset.frame);
    }
    for (std::uint32_t view = 0; view < eyes.size(); ++view)
        BOLT_TRY(renderer.draw_over(frame, overlay, renderer.picture(view)));
    return {};
}

Result<std::vector<Picture>> take_pictures(gpu::Device& device, gpu::Frames& frames, Renderer& renderer,
                                           const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                                           std::span<const Inset> insets) {
    BOLT_TRY_ASSIGN(auto frame, frames.begin());
    BOLT_TRY(render_with_insets(renderer, *frame, scene, eyes, extent, insets));
    BOLT_TRY(frames.submit(*frame));
    BOLT_TRY(frames.finish());
    std::vector<Picture> pictures;
    for (std::uint32_t view = 0; view < eyes.size(); ++view) {
        const ImageLayer made = renderer.picture(view);
        BOLT_TRY_ASSIGN(auto texels, gpu::download_image(device, *made.image, gpu::ResourceUse::transfer_from,
                                                         4, 0, made.layer));
        Picture picture{extent.width, extent.height, std::vector<std::uint8_t>(texels.size())};
        std::memcpy(picture.rgba.data(), texels.data(), texels.size());
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

}  // namespace bolt::render
