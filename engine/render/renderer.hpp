// The frame, from the scene to a picture. Renderer::render reads like it:
//
//   deform     vertices of what bends, where joints and morph targets move them
//   shadow     depth of what light 0 sees; what stands still is kept
//   surfaces   depth, normal and material of what is seen, 4 samples a pixel
//   occlusion  how much light neighbours keep away, at half the size, if the scene asks for it
//   light      every surface lit and tone-mapped, once for all samples of a pixel that show it
//   forward    what is lit as it is drawn: what blends, and what the geometry buffer has no room for
//   outline    lines around what the scene marks
//   labels     text in the scene
//
// draw_over puts an overlay on a finished picture: the user interface, and pictures of other views as insets.
//
// Light comes after, and not while parts are drawn, because a part's triangles are often smaller than the
// blocks that a rasteriser shades: on lavapipe the same picture of the reducer took nearly three times as
// long.
//
// Each pass is a class in passes/ with its pipelines. Several views are drawn in one pass by multiview, a
// layer each; on software rasterisers one after the other, each into images of its own. lavapipe (Mesa 22.3)
// draws triangles that it clips into the layer of the view before, and resolves into layer 0 whatever layer
// the view of the image begins with.
#pragma once

#include "engine/render/hot_shaders.hpp"
#include "engine/render/passes/deform.hpp"
#include "engine/render/passes/forward.hpp"
#include "engine/render/passes/labels.hpp"
#include "engine/render/passes/light.hpp"
#include "engine/render/passes/occlusion.hpp"
#include "engine/render/passes/outline.hpp"
#include "engine/render/passes/overlay.hpp"
#include "engine/render/passes/shadow.hpp"
#include "engine/render/passes/surfaces.hpp"

namespace bolt::render {

struct RendererOptions {
    std::uint32_t shadow_size = 2048;
    std::filesystem::path pipeline_cache;  // empty: none on disk
    ShaderCode shaders;                    // instead of those built in
    enum class Multiview : std::uint8_t {
        where_it_works,
        always,
        never
    } multiview = Multiview::where_it_works;
    // How far a coarser level of detail may be from the part, in pixels of the picture; 0: always all
    // triangles.
    float level_error_px = 0.0F;
    bool keep_depth = false;  // so that depth() can be read back
};

struct Statistics {
    std::uint64_t triangles = 0;
    std::uint32_t draws = 0, instances = 0;
    bool shadow_drawn = false;
};

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(gpu::Device& device, const RendererOptions& options);

    // Records a frame's views of one size. The pictures are in use `transfer_from` afterwards. Views of
    // another size (an inset, the instructor's) are another group, by any number; their pictures are kept
    // beside.
    Status render(gpu::Frame& frame, const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                  std::uint32_t group = 0);

    // Over a picture that has been rendered in this frame. Pictures that it shows are named by `picture`.
    Status draw_over(gpu::Frame& frame, const Overlay& overlay, const Layer& picture);

    [[nodiscard]] Layer picture(std::uint32_t view, std::uint32_t group = 0) const {
        return groups_.at(group).picture(view);
    }
    // The depth of each pixel's first sample, in use `transfer_from`; none without
    // RendererOptions::keep_depth. What blends is not in it.
    [[nodiscard]] Layer depth(std::uint32_t view, std::uint32_t group = 0) const {
        return options_.keep_depth ? groups_.at(group).depth(view) : Layer{};
    }
    [[nodiscard]] const Statistics& statistics() const { return statistics_; }
    // What bent in the last frame; for a look at its vertices.
    [[nodiscard]] const DeformPass& deformed() const { return deform_; }
    // Keeps compiled pipelines for the next start.
    [[nodiscard]] Status save_pipelines() const { return cache_.save(); }

  private:
    Status prepare();
    Status make_passes();
    Status resize(gpu::Frame& frame, ViewGroup& group, VkExtent2D extent, std::uint32_t views) const;
    [[nodiscard]] bool multiview() const;

    gpu::Device* device_ = nullptr;
    RendererOptions options_;
    gpu::PipelineCache cache_;
    Shaders shaders_;
    DeformPass deform_;
    ShadowPass shadow_;
    std::map<std::uint32_t, ForwardPass> forward_;      // by views
    std::map<std::uint32_t, OcclusionPass> occlusion_;  // by views
    std::map<std::uint32_t, OutlinePass> outline_;      // by views
    SurfacePass surfaces_;
    LightPass light_;
    LabelPass labels_;
    OverlayPass overlay_;
    EnvironmentLight no_environment_;
    GpuTexture white_;
    gpu::ImageView white_array_;
    std::map<std::uint32_t, ViewGroup> groups_;
    Statistics statistics_;
};

}  // namespace bolt::render
