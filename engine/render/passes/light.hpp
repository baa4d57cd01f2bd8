// Deferred lighting: shades the geometry buffer and the background. Reads four samples per pixel and writes
// one.
#pragma once

#include "engine/render/passes/parts.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

// Images that lighting reads in addition to the geometry buffer.
struct LightInputs {
    const gpu::Image* shadow_map = nullptr;
    VkImageView occlusion = VK_NULL_HANDLE;  // null: none
};

class LightPass {
  public:
    LightPass() = default;
    static Result<LightPass> create(const PassMaker& maker);

    // Leaves `targets.picture` a colour target.
    Status draw(PassContext& context, RenderTargets& targets, const DrawList& list,
                const LightInputs& inputs);

    // Sets bindings 0 and 2 to 6 of shaders that include lighting.glsl.
    void bind_inputs(PassContext& context, gpu::DescriptorWriter& writer, const LightInputs& inputs) const;

  private:
    Result<const gpu::Pipeline*> light_pipeline(gpu::Device& device, std::uint32_t features,
                                                std::uint32_t views);
    Result<VkDescriptorSet> light_set(PassContext& context, const RenderTargets& targets,
                                      const gpu::Pipeline& pipeline, const LightInputs& inputs, bool wide);
    Status draw_surfaces(PassContext& context, const RenderTargets& targets, const DrawList& list,
                         const LightInputs& inputs);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<std::pair<std::uint32_t, std::uint32_t>, gpu::Pipeline> lights_;  // by features and views
    gpu::Image albedo_table_;
    gpu::Image nothing_;  // bound if there is no wide buffer
    gpu::Sampler clamped_, nearest_, comparing_;
};

}  // namespace bolt::render
