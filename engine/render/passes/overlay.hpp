// The pass that draws an overlay onto a finished picture. Colours are decoded from sRGB and blended linearly.
#pragma once

#include "engine/render/overlay.hpp"
#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class OverlayPass {
  public:
    static Result<OverlayPass> create(const PassSetup& setup);

    // The picture is in ResourceUse::transfer_from before and after. `white`: an array image of one white
    // texel, for draws without a texture.
    Status draw(gpu::Device& device, gpu::FrameContext& frame, const Overlay& overlay,
                const ImageLayer& picture, VkImageView white);

  private:
    Result<std::vector<VkDescriptorSet>> descriptor_sets(gpu::Device& device, gpu::FrameContext& frame,
                                                         const Overlay& overlay, VkImageView white);

    gpu::Pipeline pipeline_;
    gpu::Sampler sampler_;
};

}  // namespace bolt::render
