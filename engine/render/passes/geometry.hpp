// Skinning and morphing: a compute shader writes the deformed vertices once, and all other passes draw them
// like static ones.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class DeformPass {
  public:
    DeformPass() = default;
    static Result<DeformPass> create(const PassMaker& maker);

    // Deforms all deformable parts of the scene; the results are in parts(), ready as vertex buffers.
    Status draw(PassContext& context);
    [[nodiscard]] const DeformedParts& parts() const { return parts_; }
    // The buffer of the deformed vertices, which may be copied from.
    [[nodiscard]] const gpu::Buffer& vertices() const { return vertices_; }

  private:
    struct Job {
        const Object* object = nullptr;
        const MeshPart* part = nullptr;
        shared::DeformPart numbers{};
    };
    Status plan(PassContext& context, std::vector<Job>& jobs);
    Result<VkDescriptorSet> set_for(PassContext& context, const Object& object);

    gpu::Pipeline pipeline_;
    gpu::Buffer vertices_;  // shared by frames in flight: the GPU executes them one after the other
    DeformedParts parts_;
};

// Draws depth and a geometry buffer of normal, material and grain, four samples per pixel. Maps and colours
// that vary over a part are written to a second, wide buffer, which exists only if needed.

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
