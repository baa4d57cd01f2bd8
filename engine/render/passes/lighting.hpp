// The passes that shade: deferred lighting, and forward lighting of parts that it cannot shade.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

// Images that both lighting passes read in addition to their own inputs.
struct LightInputs {
    const gpu::Image* shadow_map = nullptr;
    VkImageView occlusion = VK_NULL_HANDLE;  // ambient occlusion; null: none
};

// Deferred lighting: shades the geometry buffer and the background. Reads four samples per pixel and writes
// one.
class LightPass {
  public:
    LightPass() = default;
    static Result<LightPass> create(const PassSetup& setup);

    // Leaves `targets.picture` in ResourceUse::color_target.
    Status draw(PassContext& context, RenderTargets& targets, const DrawList& list,
                const LightInputs& inputs);

    // Sets bindings 0 and 2 to 6 of shaders that include lighting.glsl.
    void bind_inputs(PassContext& context, gpu::DescriptorWriter& writer, const LightInputs& inputs) const;

  private:
    Result<const gpu::Pipeline*> light_pipeline(gpu::Device& device, std::uint32_t features,
                                                std::uint32_t views);
    Result<VkDescriptorSet> light_set(PassContext& context, const RenderTargets& targets,
                                      const gpu::Pipeline& pipeline, const LightInputs& inputs,
                                      bool per_pixel_material);
    // Records the drawing or the dispatch for all pixels.
    Status shade_surfaces(PassContext& context, const RenderTargets& targets, const DrawList& list,
                          const LightInputs& inputs);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    ScreenStage stage_ = ScreenStage::fragment;
    std::map<std::pair<std::uint32_t, std::uint32_t>, gpu::Pipeline> lights_;  // by features and views
    gpu::Image albedo_table_;
    gpu::Image no_material_buffer_;  // bound if there is no material buffer
    gpu::Sampler clamped_, nearest_, comparing_;
};

// Draws and shades parts that blend or that the geometry buffer cannot store. Draws into a multisampled
// layer, which is then resolved and blended over the picture.
class ForwardPass {
  public:
    ForwardPass() = default;
    static Result<ForwardPass> create(const PassSetup& setup, std::uint32_t views);

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
