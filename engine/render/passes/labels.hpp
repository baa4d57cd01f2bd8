// Blends labels over the finished picture. The scene's depth determines where parts hide them.
#pragma once

#include <memory>

#include "engine/render/label_batch.hpp"
#include "engine/render/passes/pass.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class LabelPass {
  public:
    static Result<LabelPass> create(const PassMaker& maker);

    // Call it once per frame, before any view is drawn. Fonts are loaded for the first label.
    Status prepare(PassContext& context, std::span<const Eye> eyes);

    // Draws onto `targets.picture`, a colour target before and after; `targets.depth` is in use `depth_read`.
    Status draw(PassContext& context, const RenderTargets& targets);

  private:
    Status load(gpu::Device& device);
    Result<LabelBatch> batch(const Scene& scene, const Eye& eye);
    Status upload(PassContext& context);
    Result<const gpu::Pipeline*> pipeline(gpu::Device& device, std::uint32_t views);

    const gpu::PipelineCache* cache_ = nullptr;
    const Shaders* shaders_ = nullptr;
    std::map<std::uint32_t, gpu::Pipeline> pipelines_;  // by number of views
    gpu::Sampler smooth_, nearest_;
    text::Fonts fonts_;
    std::unique_ptr<text::Atlas> atlas_;
    gpu::Image image_;   // the glyph atlas
    bool fresh_ = true;  // the image has no contents yet
    gpu::TransientRange labels_, quads_;
    std::uint32_t count_ = 0;  // quads in this frame
};

}  // namespace bolt::render
