// The least that draws a scene's triangles: one colour an object, 4 samples a pixel, no light, no culling of
// objects, no sorting. What a frame of the renderer costs beside this is what its light costs.
#pragma once

#include "engine/gpu/pipeline.hpp"
#include "engine/render/renderer.hpp"

namespace bolt::bench {

class BareRenderer {
  public:
    static Result<BareRenderer> create(gpu::Device& device, VkExtent2D extent);

    Status render(gpu::Frame& frame, const render::Scene& scene, const render::Eye& eye);

  private:
    VkExtent2D extent_{};
    gpu::PipelineCache cache_;
    gpu::Pipeline pipeline_;
    gpu::Image drawn_, depth_, picture_;
};

}  // namespace bolt::bench
