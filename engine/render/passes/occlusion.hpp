// How much light neighbours keep away: depth shrunk to half the size, slices of the horizon around every
// pixel, smoothed. Where nothing was drawn nothing is computed.
#pragma once

#include "engine/render/passes/pass.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class OcclusionPass {
  public:
    static Result<OcclusionPass> create(const PassMaker& maker, std::uint32_t views);

    // From `targets.depth`, `depth_read`. Leaves its result in `targets.occlusion`, sampled.
    Status draw(PassContext& context, Targets& targets);

  private:
    Status shrink(PassContext& context, const Targets& targets);
    // A triangle over what was drawn, into `target`.
    void fill(PassContext& context, const Targets& targets, const gpu::Pipeline& pipeline,
              VkDescriptorSet set, const gpu::Image& target);

    gpu::Pipeline shrink_, slices_, smooth_;
    gpu::Sampler nearest_;
};

}  // namespace bolt::render
