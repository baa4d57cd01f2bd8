// Draws parts with their materials; shared by several passes.
#pragma once

#include <functional>

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

// The vertex stage of every pipeline that draws parts with scene.vert.
gpu::GraphicsInfo part_pipeline(const Shaders& shaders, const PipelineKind& kind, std::uint32_t views);

// Selects the pipeline of each kind of part. `frame_set` creates descriptor set 0.
struct PartDrawing {
    std::function<bool(const PipelineKind&)> wanted;
    std::function<Result<const gpu::Pipeline*>(const PipelineKind&)> pipeline;
    std::function<Result<VkDescriptorSet>(const gpu::Pipeline&)> frame_set;
    std::function<VkRect2D(const PipelineKind&)> area;  // scissor rectangle; null: the whole picture
};

// Draws the list in its order. Set 1 holds a material's maps, the push constant its index.
Status draw_parts(PassContext& context, const DrawList& list, const PartDrawing& drawing);

}  // namespace bolt::render
