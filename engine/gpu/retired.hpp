// What the program has let go of while the GPU may still use it: kept until the frame that used it last is
// done.
#pragma once

#include <variant>
#include <vector>

#include "engine/gpu/resources.hpp"

namespace bolt::gpu {

class Retired {
  public:
    using Thing = std::variant<Buffer, Image, ImageView, Sampler, PipelineHandle, PipelineLayout,
                               DescriptorPool, SwapchainHandle, Semaphore>;

    void add(Thing thing) { things_.push_back(std::move(thing)); }
    void destroy() { things_.clear(); }

  private:
    std::vector<Thing> things_;
};

}  // namespace bolt::gpu
