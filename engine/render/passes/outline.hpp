// A line around the objects that a scene marks, seen through whatever stands before them: their shapes as
// flat marks, then a ring around every pixel. Only where the marks are on the picture.
#pragma once

#include "engine/render/passes/parts.hpp"
#include "engine/render/targets.hpp"

namespace bolt::render {

class OutlinePass {
  public:
    static Result<OutlinePass> create(const PassMaker& maker, std::uint32_t views);

    // Blends the lines into `targets.picture`, a colour target before and after.
    Status draw(PassContext& context, Targets& targets, const DrawList& list);

  private:
    Status draw_marks(PassContext& context, const Targets& targets, const DrawList& list);

    gpu::Pipeline marks_, lines_;
    gpu::Sampler clamped_;
};

}  // namespace bolt::render
