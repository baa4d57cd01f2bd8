// The shadow map of light 0. The map of static objects is cached and redrawn only when it changes; moving
// objects are drawn over a copy of it.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class ShadowPass {
  public:
    static Result<ShadowPass> create(const PassMaker& maker, std::uint32_t size);

    // Returns whether light 0 casts a shadow in this scene, and sets the shadow view. Moving objects do not
    // influence it.
    static bool describe(const Scene& scene, shared::FrameData& frame);

    Status draw(PassContext& context);
    // The map that shaders read, in use `depth_read`.
    [[nodiscard]] const gpu::Image& map() const { return moving_ ? all_ : still_; }
    // Whether the static map was redrawn in the last frame.
    [[nodiscard]] bool drawn() const { return drawn_; }

  private:
    Status draw_into(PassContext& context, const gpu::Image& target, const DrawList& list, bool clear);

    gpu::Pipeline pipeline_;
    gpu::Image still_, all_;       // all_: created when something moves
    bool moving_ = false;          // the map to read is all_
    std::uint64_t still_key_ = 0;  // hash of the static map's contents; 0: empty
    bool drawn_ = false;
};

// Ambient occlusion: halves the depth buffer, integrates horizon slices around every pixel, and smooths the
// result. Pixels without geometry are skipped.

class OcclusionPass {
  public:
    static Result<OcclusionPass> create(const PassMaker& maker, std::uint32_t views);

    // Reads `targets.depth` in use `depth_read`. Leaves its result in `targets.occlusion`, in use `sampled`.
    Status draw(PassContext& context, RenderTargets& targets);

  private:
    Status shrink(PassContext& context, const RenderTargets& targets);
    // Draws a triangle over the drawn area into `target`.
    void fill(PassContext& context, const RenderTargets& targets, const gpu::Pipeline& pipeline,
              VkDescriptorSet set, const gpu::Image& target);

    gpu::Pipeline shrink_, slices_, smooth_;
    gpu::Sampler nearest_;
};

}  // namespace bolt::render
