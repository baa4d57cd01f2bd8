// What is seen, without light: depth, and a geometry buffer of normal, material and grain, four samples a
// pixel. Maps and colours that vary over a part go into a second, wide buffer, which is there only when
// something needs it.
#pragma once

#include "engine/render/passes/parts.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class SurfacePass {
  public:
    static Result<SurfacePass> create(const PassMaker& maker) { return SurfacePass(maker); }

    // Leaves `targets.depth` `depth_read`, the geometry buffers sampled.
    Status draw(PassContext& context, Targets& targets, const DrawList& list);

    SurfacePass() = default;

  private:
    explicit SurfacePass(const PassMaker& maker) : cache_(&maker.cache), shaders_(&maker.shaders) {}
    Result<const gpu::Pipeline*> pipeline(gpu::Device& device, const Kind& kind, std::uint32_t views,
                                          bool wide);

    struct Variant {
        Kind kind;
        std::uint32_t views = 1;
        bool wide = false;
        friend auto operator<=>(const Variant&, const Variant&) = default;
    };
    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<Variant, gpu::Pipeline> pipelines_;
};

}  // namespace bolt::render
