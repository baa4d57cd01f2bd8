// An overlay over a finished picture, by one pipeline: colours are made linear and blended as light is, onto
// sRGB.
#pragma once

#include "engine/render/overlay.hpp"
#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class OverlayPass {
  public:
    static Result<OverlayPass> create(const PassMaker& maker);

    // Onto a picture that is in use `transfer_from`, and is so afterwards. `white` is an array of one texel.
    Status draw(gpu::Device& device, gpu::Frame& frame, const Overlay& overlay, const Layer& picture,
                VkImageView white);

  private:
    Result<std::vector<VkDescriptorSet>> sets_of(gpu::Device& device, gpu::Frame& frame,
                                                 const Overlay& overlay, VkImageView white);

    gpu::Pipeline pipeline_;
    gpu::Sampler sampler_;
};

}  // namespace bolt::render
