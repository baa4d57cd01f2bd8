// What stands behind the menu: the machine that is chosen, drawn once and kept. Its files are read beside the
// menu; nothing waits for them.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "engine/render/renderer.hpp"
#include "game/view/stage.hpp"

namespace bolt::trainer {

class Backdrop {
  public:
    // Its files are read from now on, unless they have been or an earlier one is under way.
    void want(const std::string& assembly);

    // In each frame of the menu: puts what has been read on the GPU and draws it, if it has not been for a
    // picture of this size.
    Status draw(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame, VkExtent2D size);

    // None yet: what is wanted could not be read, or has not been.
    [[nodiscard]] std::optional<render::ImageLayer> picture(const render::Renderer& renderer) const;
    [[nodiscard]] bool reading() const { return coming_.valid(); }

    // What is on the GPU, which must be idle.
    void drop();

  private:
    Status put_up(gpu::Device& device, const view::Subject& subject);

    std::string wanted_, shown_;  // names
    std::string coming_name_;
    std::future<view::LoadedSubject> coming_;
    render::EnvironmentLight light_;
    std::unique_ptr<view::Stage> stage_;
    view::Viewpoint from_;
    VkExtent2D drawn_{};  // none: has to be
};

}  // namespace bolt::trainer
