// The passes for shadows: the shadow map of light 0, and ambient occlusion.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

// Draws the shadow map of light 0. The map of static objects is cached and redrawn only when they change;
// moving objects are drawn into a copy of it.
class ShadowPass {
  public:
    static Result<ShadowPass> create(const PassSetup& setup, std::uint32_t size);

    // If light 0 casts a shadow, sets the shadow view in `frame`; returns false if it casts none. The view is
    // fitted to the static objects that cast shadows, or to the moving ones if there are no static ones.
    static bool set_shadow_view(const Scene& scene, shared::FrameData& frame);

    // Redraws the maps if necessary. Does nothing if light 0 casts no shadow.
    Status draw(PassContext& context);
    // Returns the map for shaders, in ResourceUse::depth_read.
    [[nodiscard]] const gpu::Image& map() const { return moving_ ? combined_map_ : static_map_; }
    // Returns whether the last draw() redrew the static map.
    [[nodiscard]] bool static_map_redrawn() const { return static_map_redrawn_; }

  private:
    Status draw_into(PassContext& context, const gpu::Image& target, const DrawList& list, bool clear);

    gpu::Pipeline pipeline_;
    gpu::Image static_map_;
    gpu::Image combined_map_;           // with moving objects; created when the first object moves
    bool moving_ = false;               // shaders read combined_map_
    std::uint64_t static_map_key_ = 0;  // hash of the static map's contents; 0: empty
    bool static_map_redrawn_ = false;
};

// Ambient occlusion at half size: halves the depth buffer, integrates the unoccluded angle between the
// horizons of one slice per pixel, and smooths the result. Pixels without geometry get the value 1.
class OcclusionPass {
  public:
    static Result<OcclusionPass> create(const PassSetup& setup, std::uint32_t views);

    // Reads `targets.depth` in ResourceUse::depth_read. Leaves its result in `targets.occlusion`, in
    // ResourceUse::sampled.
    Status draw(PassContext& context, RenderTargets& targets);

  private:
    void shrink(PassContext& context, const RenderTargets& targets, VkDescriptorSet set);
    // Runs a pipeline for every pixel with geometry and writes to `target`.
    void draw_into(PassContext& context, const RenderTargets& targets, const gpu::Pipeline& pipeline,
                   VkDescriptorSet set, const gpu::Image& target);
    // The same in a compute shader, also for pixels without geometry.
    static void compute(PassContext& context, const gpu::Pipeline& pipeline, VkDescriptorSet set,
                        const gpu::Image& target);

    ScreenStage stage_ = ScreenStage::fragment;
    gpu::Pipeline shrink_, slices_, smooth_;
    gpu::Sampler nearest_;
};

}  // namespace bolt::render
