// Draws depth and a geometry buffer of normal, material and grain, four samples per pixel. Maps and colours
// that vary over a part are written to a second, wide buffer, which exists only if needed.
#pragma once

#include "engine/render/passes/parts.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class SurfacePass {
  public:
    static Result<SurfacePass> create(const PassMaker& maker) { return SurfacePass(maker); }

    // Leaves `targets.depth` in use `depth_read` and the geometry buffers in use `sampled`.
    Status draw(PassContext& context, RenderTargets& targets, const DrawList& list);

    SurfacePass() = default;

  private:
    explicit SurfacePass(const PassMaker& maker) : cache_(&maker.cache), shaders_(&maker.shaders) {}
    Result<const gpu::Pipeline*> pipeline(gpu::Device& device, const PipelineKind& kind, std::uint32_t views,
                                          bool wide);

    struct Variant {
        PipelineKind kind;
        std::uint32_t views = 1;
        bool wide = false;
        friend auto operator<=>(const Variant&, const Variant&) = default;
    };
    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<Variant, gpu::Pipeline> pipelines_;
};

}  // namespace bolt::render
