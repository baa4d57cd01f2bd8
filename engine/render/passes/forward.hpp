// What is lit as it is drawn, because it blends or has more than the geometry buffer keeps: four samples a
// pixel of their own, resolved, then laid over the picture.
#pragma once

#include "engine/render/passes/light.hpp"

namespace bolt::render {

class ForwardPass {
  public:
    ForwardPass() = default;
    static Result<ForwardPass> create(const PassMaker& maker, std::uint32_t views);

    // After light; `targets.picture` is and stays a colour target.
    Status draw(PassContext& context, Targets& targets, const DrawList& list, const LightPass& light,
                const LightInputs& inputs);

  private:
    Result<const gpu::Pipeline*> forward_pipeline(gpu::Device& device, const Kind& kind);
    Result<const gpu::Pipeline*> ghost_pipeline(gpu::Device& device, const Kind& kind);
    Status draw_all_parts(PassContext& context, const DrawList& list, const LightPass& light,
                          const LightInputs& inputs);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::uint32_t views_ = 1;
    std::map<Kind, gpu::Pipeline> forwards_, ghosts_;
    gpu::Pipeline over_;
    gpu::Sampler nearest_;
};

}  // namespace bolt::render
