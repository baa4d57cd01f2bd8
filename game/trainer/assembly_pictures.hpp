// Pictures of the menu: the selected assembly behind it, and a thumbnail of every assembly. Models are loaded
// in the background, one after the other, the selected one first; each picture is drawn once for a size.
#pragma once

#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/render/renderer.hpp"
#include "game/view/shown_model.hpp"

namespace bolt::trainer {

class AssemblyPictures {
  public:
    // The pictures that a frame of the menu needs.
    struct Request {
        std::string selected;             // name of the assembly that is shown behind the menu
        std::vector<std::string> listed;  // names of the assemblies with thumbnails
        VkExtent2D size{}, thumbnail{};   // px
        // Where the assembly stands behind the menu, as a shift from the middle of the picture: shares of
        // half its width and half its height, to the right and up.
        glm::vec2 shift{0.0F};
    };

    // Call it in every frame of the menu. Draws at most one picture, if its model is loaded, and starts to
    // load the next one. An assembly that cannot be loaded has no picture; the menu says why.
    Status draw(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame,
                const Request& request);

    // The selected assembly in the last request; empty until it is drawn.
    [[nodiscard]] std::optional<render::ImageLayer> picture(const render::Renderer& renderer) const;
    // Empty until it is drawn.
    [[nodiscard]] std::optional<render::ImageLayer> thumbnail(const std::string& assembly) const;
    // True if there was a request and each of its pictures is drawn or cannot be.
    [[nodiscard]] bool complete() const {
        return request_.size.width > 0 && !loading_.valid() && next_to_load().empty();
    }

    // Releases all GPU objects. The GPU must be idle.
    void release();

  private:
    // The picture behind the menu.
    struct Backdrop {
        std::string assembly;
        VkExtent2D size{};
        glm::vec2 shift{0.0F};
        friend bool operator==(const Backdrop& a, const Backdrop& b) {
            return a.assembly == b.assembly && a.size.width == b.size.width &&
                   a.size.height == b.size.height && a.shift == b.shift;
        }
    };

    [[nodiscard]] bool needs_thumbnail(const std::string& assembly) const;
    [[nodiscard]] std::string next_to_load() const;
    Status upload(gpu::Device& device, const view::LoadedModel& model);
    Status draw_backdrop(render::Renderer& renderer, gpu::FrameContext& frame);
    Status draw_thumbnail(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame);

    Request request_;
    std::string loading_name_, uploaded_;  // names of assemblies
    std::future<view::ModelLoadResult> loading_;
    std::vector<std::string> failed_;  // assemblies that cannot be loaded
    render::EnvironmentLight light_;
    std::unique_ptr<view::ShownModel> model_;  // of `uploaded_`
    view::Viewpoint viewpoint_;
    std::optional<Backdrop> drawn_;
    std::map<std::string, gpu::Image> thumbnails_;  // in ResourceUse::transfer_from
};

}  // namespace bolt::trainer
