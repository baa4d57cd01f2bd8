// The passes that draw annotations: outlines of objects, and labels.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "engine/render/passes/pass.hpp"
#include "engine/render/scene.hpp"
#include "engine/text/atlas.hpp"
#include "shaders/labels.h"

namespace bolt::render {

// Draws outlines of objects, visible through occluders. First draws each object's shape, its mark, in the
// colour of its outline. Then searches for marks on rings around each pixel of the area that the outlines may
// cover.
class OutlinePass {
  public:
    static Result<OutlinePass> create(const PassSetup& setup, std::uint32_t views);

    // Blends the lines into `targets.picture`, a colour target before and after.
    Status draw(PassContext& context, RenderTargets& targets, const DrawList& list);

  private:
    Status draw_marks(PassContext& context, const RenderTargets& targets, const DrawList& list);

    gpu::Pipeline marks_, lines_;
    gpu::Sampler clamped_;
};

// Labels prepared for the GPU, the farthest label first. The quads of a label are in drawing order: its
// background, the outlines of its glyphs, its glyphs.
struct LabelBatch {
    std::vector<shared::LabelFrame> labels;
    std::vector<shared::LabelQuad> quads;
};

// Returns nullopt if the atlas is full. `clip_from_world`: the view by whose depth the labels are sorted.
std::optional<LabelBatch> make_label_batch(std::span<const Label> labels, const glm::mat4& clip_from_world,
                                           const text::Fonts& fonts, text::Atlas& atlas);

// Blends labels over the finished picture. The scene's depth determines where parts hide them.
class LabelPass {
  public:
    static Result<LabelPass> create(const PassSetup& setup);

    // Call it once per group of views, before they are drawn. Loads the fonts when the first label appears.
    Status prepare(PassContext& context, std::span<const Eye> eyes);

    // Draws onto `targets.picture`, a colour target before and after; `targets.depth` is in
    // ResourceUse::depth_read.
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
    std::uint32_t count_ = 0;  // quads since the last prepare()
};

}  // namespace bolt::render
