// Outlines of marked objects, visible through occluders: draws their shapes as flat marks, then searches a
// ring around every pixel. Works only in the area that the marks cover.
#pragma once

#include "engine/render/passes/parts.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class OutlinePass {
  public:
    static Result<OutlinePass> create(const PassMaker& maker, std::uint32_t views);

    // Blends the lines into `targets.picture`, a colour target before and after.
    Status draw(PassContext& context, RenderTargets& targets, const DrawList& list);

  private:
    Status draw_marks(PassContext& context, const RenderTargets& targets, const DrawList& list);

    gpu::Pipeline marks_, lines_;
    gpu::Sampler clamped_;
};

}  // namespace bolt::render
