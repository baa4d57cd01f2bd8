// The renderer, insets, and pictures that are copied to the CPU. Renderer::render runs these passes:
//
//   deform     vertices of deformable parts, moved by the joints of a glTF skin and by morph targets
//   shadow     depth seen from light 0; static objects are cached
//   surfaces   depth, normal and material of visible surfaces, 4 samples per pixel
//   occlusion  ambient occlusion at half size, if the scene requests it
//   light      shading and tone mapping, once for each surface in a pixel, not for each sample
//   forward    parts shaded while drawn: blended ones, and those the geometry buffer cannot store
//   outline    lines around marked objects
//   labels     text in the scene
//   panels     flat pictures in the scene
//
// Renderer::draw_over draws an overlay on a finished picture: the user interface, or pictures of other views
// as insets.
//
// Lighting is deferred, because a part's triangles are often smaller than the blocks that a rasteriser
// shades: with forward lighting the same picture of the assembly zq350 took nearly three times as long on
// lavapipe.
//
// Each pass is a class in passes/ with its pipelines. A group is the views of one call of Renderer::render;
// they have one size. With multiview one draw call renders all views of the group, one layer each. If the
// driver's multiview is wrong (multiview_works), each view is drawn by itself, into images of its own: the
// group is then several batches, each with one view. Separate images are needed because lavapipe
// of Mesa 22.3 always resolves into layer 0, even if the image view begins with another layer.
#pragma once

#include <optional>

#include "engine/render/hot_shaders.hpp"
#include "engine/render/passes/annotations.hpp"
#include "engine/render/passes/geometry.hpp"
#include "engine/render/passes/lighting.hpp"
#include "engine/render/passes/overlay.hpp"
#include "engine/render/passes/panels.hpp"
#include "engine/render/passes/shadows.hpp"

namespace bolt::render {

struct RendererOptions {
    std::uint32_t shadow_size = 2048;      // texels per side of the shadow map
    std::filesystem::path pipeline_cache;  // empty: no cache on disk
    ShaderCode shaders;                    // replacements of built-in shaders
    enum class Multiview : std::uint8_t { where_it_works, always, never };
    Multiview multiview = Multiview::where_it_works;
    // Ambient occlusion and lighting: fragment or compute shaders. Compute shaders suit GPUs with few units
    // for graphics. On lavapipe compute shaders are slower, because they repeat for each pixel what
    // light.vert computes once; on a GPU they were not measured yet.
    ScreenStage screen_stage = ScreenStage::fragment;
    // The error allowed for coarser levels of detail, in pixels of the picture; 0: always draw all triangles.
    float level_error_px = 0.0F;
    bool keep_depth = false;  // required by depth()
    // Parts are drawn up to this distance beyond the edges of the picture, so that none is missing after
    // move_eyes(). In half widths and half heights of the picture.
    float margin = 0.0F;
};

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(gpu::Device& device, const RendererOptions& options);

    // Records the views of a frame that have the same size: one to MAX_VIEWS eyes, otherwise it fails.
    // Afterwards their images are in ResourceUse::transfer_from. Views of another size, such as an inset or
    // the close-up in a lesson, form another group, which has its own pictures; `group` is any number that
    // identifies it.
    Status render(gpu::FrameContext& frame, const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                  std::uint32_t group = 0);

    // Replaces the eyes of a group between render() and the submission of the frame: the GPU draws the
    // group's pictures from the new eyes. Culling and levels of detail stay those of the old eyes, so the
    // picture may move by RendererOptions::margin at most. `eyes`: as many as render() got.
    void move_eyes(std::span<const Eye> eyes, std::uint32_t group = 0);

    // Draws an overlay over a picture that was rendered in this frame, or over a PanelPicture. The picture is
    // in ResourceUse::transfer_from before and after. The overlay may contain pictures of other groups.
    // Fails if the overlay contains a layer of the same image.
    Status draw_over(gpu::FrameContext& frame, const Overlay& overlay, const ImageLayer& picture);

    [[nodiscard]] ImageLayer picture(std::uint32_t view, std::uint32_t group = 0) const {
        return groups_.at(group).picture(view);
    }
    // Returns the depth of each pixel's first sample, without blended parts, in ResourceUse::transfer_from.
    // Empty without RendererOptions::keep_depth.
    [[nodiscard]] ImageLayer depth(std::uint32_t view, std::uint32_t group = 0) const {
        return options_.keep_depth ? groups_.at(group).depth(view) : ImageLayer{};
    }
    [[nodiscard]] const Statistics& statistics(std::uint32_t group = 0) const {
        return groups_.at(group).statistics;
    }
    // Returns the pass with the deformed vertices of the last render(), for tests.
    [[nodiscard]] const DeformPass& deform_pass() const { return deform_; }
    // Writes compiled pipelines to the cache file for the next start.
    [[nodiscard]] Status save_pipelines() const { return cache_.save(); }

  private:
    Status prepare();
    Status make_passes();
    Status resize(gpu::FrameContext& frame, ViewGroup& group, VkExtent2D extent, std::uint32_t views);
    Result<bool> draws_views_together();

    gpu::Device* device_ = nullptr;
    RendererOptions options_;
    gpu::PipelineCache cache_;
    Shaders shaders_;
    DeformPass deform_;
    ShadowPass shadow_;
    std::map<std::uint32_t, ForwardPass> forward_;      // by number of views
    std::map<std::uint32_t, OcclusionPass> occlusion_;  // by number of views
    std::map<std::uint32_t, OutlinePass> outline_;      // by number of views
    SurfacePass surfaces_;
    LightPass light_;
    LabelPass labels_;
    PanelPass panels_;
    OverlayPass overlay_;
    EnvironmentLight no_environment_;
    GpuTexture white_;
    gpu::ImageView white_array_;
    std::map<std::uint32_t, ViewGroup> groups_;
    std::optional<bool> multiview_works_;  // unknown until several views are drawn
};

// A second view in a corner of the picture, as `boltwright render --inset` draws it.
struct Inset {
    Eye eye;
    Rectangle place;  // in whole pixels; the view is rendered at this size
    float border_px = 2.0F;
    glm::vec4 border{0.92F, 0.94F, 0.96F, 1.0F};  // sRGB, straight alpha
};

// Returns a rectangle in the lower right corner: `share` of the picture's width, with the picture's aspect
// ratio.
Rectangle inset_rectangle(VkExtent2D picture, float share);

// Renders the views, and draws each inset over all of them. Inset i uses the renderer's group i + 1.
Status render_with_insets(Renderer& renderer, gpu::FrameContext& frame, const Scene& scene,
                          std::span<const Eye> eyes, VkExtent2D extent, std::span<const Inset> insets);

struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // sRGB, rows from the top
};

// Renders one picture per eye and copies it to the CPU.
Result<std::vector<Picture>> take_pictures(gpu::Device& device, gpu::Frames& frames, Renderer& renderer,
                                           const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                                           std::span<const Inset> insets = {});

}  // namespace bolt::render
