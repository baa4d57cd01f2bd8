#include "engine/render/picture.hpp"

#include <cstring>

#include "engine/gpu/transfer.hpp"

namespace bolt::render {

Result<std::vector<Picture>> take_pictures(gpu::Device& device, gpu::Frames& frames, Renderer& renderer,
                                           const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                                           std::span<const Inset> insets) {
    Result<gpu::Frame*> frame = frames.begin();
    if (!frame) return fail(frame.error());
    if (Status drawn = render_with_insets(renderer, **frame, scene, eyes, extent, insets); !drawn)
        return fail(drawn.error());
    if (Status sent = frames.submit(**frame); !sent) return fail(sent.error());
    if (Status done = frames.finish(); !done) return fail(done.error());
    std::vector<Picture> pictures;
    for (std::uint32_t view = 0; view < eyes.size(); ++view) {
        const Layer made = renderer.picture(view);
        Result<std::vector<std::byte>> texels =
            gpu::download_image(device, *made.image, gpu::Use::transfer_from, 4, 0, made.layer);
        if (!texels) return fail(texels.error());
        Picture picture{extent.width, extent.height, std::vector<std::uint8_t>(texels->size())};
        std::memcpy(picture.rgba.data(), texels->data(), texels->size());
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

}  // namespace bolt::render
