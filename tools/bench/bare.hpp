// A minimal renderer of a scene's triangles: one colour per object, 4 samples per pixel, no light, no culling
// of objects, no sorting. The rest of the renderer's time is the cost of its light.
#pragma once

#include "engine/gpu/pipeline.hpp"
#include "engine/render/renderer.hpp"

namespace bolt::bench {

class BareRenderer {
  public:
    static Result<BareRenderer> create(gpu::Device& device, VkExtent2D extent);

    Status render(gpu::FrameContext& frame, const render::Scene& scene, const render::Eye& eye);

  private:
    VkExtent2D extent_{};
    gpu::PipelineCache cache_;
    gpu::Pipeline pipeline_;
    gpu::Image drawn_, depth_, picture_;
};

}  // namespace bolt::bench
