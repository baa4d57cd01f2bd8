// The picture behind the menu: the selected assembly, loaded in the background and drawn once.
#pragma once

#include <future>
#include <optional>
#include <string>

#include "engine/render/renderer.hpp"
#include "game/view/shown_model.hpp"

namespace bolt::trainer {

class Backdrop {
  public:
    // Selects an assembly by name and starts to load it, unless it is loaded or another one is being loaded;
    // call it every frame.
    void select(const std::string& assembly);

    // Call it in every frame of the menu. Uploads the assembly once it is loaded and renders it if the
    // picture does not exist in this size. An assembly that cannot be loaded is not drawn; the error is
    // reported when its lesson starts.
    Status draw(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame, VkExtent2D size);

    // The picture of the selected assembly; empty until it is drawn.
    [[nodiscard]] std::optional<render::ImageLayer> picture(const render::Renderer& renderer) const;
    [[nodiscard]] bool loading() const { return loading_.valid(); }

    // Releases all GPU objects. The GPU must be idle.
    void release();

  private:
    Status upload(gpu::Device& device, const view::LoadedModel& model);

    std::string selected_, uploaded_, loading_name_;  // names of assemblies
    std::future<view::ModelLoadResult> loading_;
    render::EnvironmentLight light_;
    std::unique_ptr<view::ShownModel> model_;
    view::Viewpoint viewpoint_;
    VkExtent2D drawn_size_{};  // 0 × 0: not drawn
};

}  // namespace bolt::trainer
