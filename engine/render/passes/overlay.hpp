// Draws an overlay onto a finished picture with one pipeline. Colours are decoded from sRGB and blended
// linearly.
#pragma once

#include "engine/render/overlay.hpp"
#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class OverlayPass {
  public:
    static Result<OverlayPass> create(const PassMaker& maker);

    // The picture is in use `transfer_from` before and after. `white` is an array of one texel.
    Status draw(gpu::Device& device, gpu::FrameContext& frame, const Overlay& overlay,
                const ImageLayer& picture, VkImageView white);

  private:
    Result<std::vector<VkDescriptorSet>> sets_of(gpu::Device& device, gpu::FrameContext& frame,
                                                 const Overlay& overlay, VkImageView white);

    gpu::Pipeline pipeline_;
    gpu::Sampler sampler_;
};

}  // namespace bolt::render
