// Labels over the finished picture, blended; where parts are in front of them is read from the scene's depth.
#pragma once

#include <memory>

#include "engine/render/label_batch.hpp"
#include "engine/render/passes/pass.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class LabelPass {
  public:
    static Result<LabelPass> create(const PassMaker& maker);

    // Once a frame, before any view is drawn. Fonts are loaded when there is the first label.
    Status prepare(PassContext& context, std::span<const Eye> eyes);

    // Onto `targets.picture`, which is and stays a colour target; `targets.depth` is `depth_read`.
    Status draw(PassContext& context, const Targets& targets);

  private:
    Status load(gpu::Device& device);
    Result<LabelBatch> batch(const Scene& scene, const Eye& eye);
    Status upload(PassContext& context);
    Result<const gpu::Pipeline*> pipeline(gpu::Device& device, std::uint32_t views);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<std::uint32_t, gpu::Pipeline> pipelines_;  // by views
    gpu::Sampler smooth_, nearest_;
    text::Fonts fonts_;
    std::unique_ptr<text::Atlas> atlas_;
    gpu::Image image_;   // of the atlas
    bool fresh_ = true;  // nothing is in it yet
    gpu::Piece labels_, quads_;
    std::uint32_t count_ = 0;  // quads of this frame
};

}  // namespace bolt::render
