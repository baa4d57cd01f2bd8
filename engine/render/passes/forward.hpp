// Draws and shades parts that blend or that the geometry buffer cannot store: into a multisampled layer,
// which is resolved and blended over the picture.
#pragma once

#include "engine/render/passes/light.hpp"

namespace bolt::render {

class ForwardPass {
  public:
    ForwardPass() = default;
    static Result<ForwardPass> create(const PassMaker& maker, std::uint32_t views);

    // Call it after the light pass; `targets.picture` is a colour target before and after.
    Status draw(PassContext& context, RenderTargets& targets, const DrawList& list, const LightPass& light,
                const LightInputs& inputs);

  private:
    Result<const gpu::Pipeline*> forward_pipeline(gpu::Device& device, const PipelineKind& kind);
    Result<const gpu::Pipeline*> ghost_pipeline(gpu::Device& device, const PipelineKind& kind);
    Status draw_all_parts(PassContext& context, const DrawList& list, const LightPass& light,
                          const LightInputs& inputs);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::uint32_t views_ = 1;
    std::map<PipelineKind, gpu::Pipeline> forwards_, ghosts_;
    gpu::Pipeline over_;
    gpu::Sampler nearest_;
};

}  // namespace bolt::render
