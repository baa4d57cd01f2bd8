// Ambient occlusion: halves the depth buffer, integrates horizon slices around every pixel, and smooths the
// result. Pixels without geometry are skipped.
#pragma once

#include "engine/render/passes/pass.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class OcclusionPass {
  public:
    static Result<OcclusionPass> create(const PassMaker& maker, std::uint32_t views);

    // Reads `targets.depth` in use `depth_read`. Leaves its result in `targets.occlusion`, in use `sampled`.
    Status draw(PassContext& context, RenderTargets& targets);

  private:
    Status shrink(PassContext& context, const RenderTargets& targets);
    // Draws a triangle over the drawn area into `target`.
    void fill(PassContext& context, const RenderTargets& targets, const gpu::Pipeline& pipeline,
              VkDescriptorSet set, const gpu::Image& target);

    gpu::Pipeline shrink_, slices_, smooth_;
    gpu::Sampler nearest_;
};

}  // namespace bolt::render
