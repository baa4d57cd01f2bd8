// Flat pictures in the scene: the user interface in a headset and on projection walls.
#pragma once

#include <map>

#include "engine/render/passes/pass.hpp"
#include "engine/render/scene.hpp"

namespace bolt::render {

// The picture of a panel, which an overlay is drawn onto (Renderer::draw_over). Its colours are premultiplied
// by their alpha. It is in ResourceUse::transfer_from except while it is cleared or drawn.
class PanelPicture {
  public:
    static Result<PanelPicture> create(gpu::Device& device, VkExtent2D extent);
    // Makes the picture transparent. Call it once a frame, before the overlay is drawn.
    void clear(gpu::FrameContext& frame);
    [[nodiscard]] ImageLayer layer() const { return {&image_, 0}; }
    [[nodiscard]] const gpu::Image& image() const { return image_; }
    [[nodiscard]] VkExtent2D extent() const { return image_.info().extent; }
    [[nodiscard]] gpu::Image release() { return std::move(image_); }  // for FrameContext::retire

  private:
    gpu::Image image_;
    bool fresh_ = true;  // it has no contents yet
};

// Blends the panels over the finished picture, the farthest first. Parts in front of a panel hide it.
class PanelPass {
  public:
    static Result<PanelPass> create(const PassSetup& setup);

    // Draws onto `targets.picture`, a colour target before and after; `targets.depth` is in
    // ResourceUse::depth_read.
    Status draw(PassContext& context, const RenderTargets& targets);

  private:
    Result<const gpu::Pipeline*> pipeline(gpu::Device& device, std::uint32_t views);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<std::uint32_t, gpu::Pipeline> pipelines_;  // by number of views
    gpu::Sampler smooth_, nearest_;
};

}  // namespace bolt::render
