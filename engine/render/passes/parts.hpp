// Drawing parts with their materials, whatever a pass makes of them.
#pragma once

#include <functional>

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

// The vertex side of every pipeline that draws parts with scene.vert.
gpu::GraphicsInfo part_pipeline(const Shaders& shaders, const Kind& kind, std::uint32_t views);

// Which pipeline a kind is drawn with; its set 0 is made by `frame_set`.
struct PartDrawing {
    std::function<bool(const Kind&)> wanted;
    std::function<Result<const gpu::Pipeline*>(const Kind&)> pipeline;
    std::function<Result<VkDescriptorSet>(const gpu::Pipeline&)> frame_set;
    std::function<VkRect2D(const Kind&)>
        area;  // of the picture, outside of which nothing is drawn; none: all
};

// Records them in the list's order. Set 1: a material's maps; push constant: its index.
Status draw_parts(PassContext& context, const DrawList& list, const PartDrawing& drawing);

}  // namespace bolt::render
