// Depth of what light 0 sees. What stands still is kept and drawn again only when it has changed; what moves
// is drawn over a copy of it.
#pragma once

#include "engine/render/passes/pass.hpp"

namespace bolt::render {

class ShadowPass {
  public:
    static Result<ShadowPass> create(const PassMaker& maker, std::uint32_t size);

    // Whether light 0 casts a shadow in this scene, and how the map sees the world. What moves doesn't change
    // it.
    static bool describe(const Scene& scene, shared::Frame& frame);

    Status draw(PassContext& context);
    // What the scene reads, `depth_read`.
    [[nodiscard]] const gpu::Image& map() const { return moving_ ? all_ : still_; }
    // Whether what stands still was drawn in the last frame.
    [[nodiscard]] bool drawn() const { return drawn_; }

  private:
    Status draw_into(PassContext& context, const gpu::Image& target, const DrawList& list, bool clear);

    gpu::Pipeline pipeline_;
    gpu::Image still_, all_;       // all_: made when something moves
    bool moving_ = false;          // all_ is the one to read
    std::uint64_t still_key_ = 0;  // of what the image holds; 0: nothing
    bool drawn_ = false;
};

}  // namespace bolt::render
