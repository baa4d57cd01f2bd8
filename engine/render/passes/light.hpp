// Light: the picture from the geometry buffer, and what lies behind it. It reads four samples a pixel and
// writes one.
#pragma once

#include "engine/render/passes/parts.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

// Images that light reads beside the geometry buffer.
struct LightInputs {
    const gpu::Image* shadow_map = nullptr;
    VkImageView occlusion = VK_NULL_HANDLE;  // null: none
};

class LightPass {
  public:
    LightPass() = default;
    static Result<LightPass> create(const PassMaker& maker);

    // Leaves `targets.picture` a colour target.
    Status draw(PassContext& context, Targets& targets, const DrawList& list, const LightInputs& inputs);

    // Bindings 0 and 2 to 6 of what includes lighting.glsl.
    void bind_inputs(PassContext& context, gpu::SetWriter& writer, const LightInputs& inputs) const;

  private:
    Result<const gpu::Pipeline*> light_pipeline(gpu::Device& device, std::uint32_t features,
                                                std::uint32_t views);
    Result<VkDescriptorSet> light_set(PassContext& context, const Targets& targets,
                                      const gpu::Pipeline& pipeline, const LightInputs& inputs, bool wide);
    Status draw_surfaces(PassContext& context, const Targets& targets, const DrawList& list,
                         const LightInputs& inputs);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<std::pair<std::uint32_t, std::uint32_t>, gpu::Pipeline> lights_;  // by features and views
    gpu::Image albedo_table_;
    gpu::Image nothing_;  // bound where there is no wide buffer
    gpu::Sampler clamped_, nearest_, comparing_;
};

}  // namespace bolt::render
