// All passes share these: render targets, formats, the context of a frame, and commands that draw parts.
#pragma once

#include <cstring>
#include <functional>

#include "engine/gpu/frames.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/draw_list.hpp"

namespace bolt::render {

// Images of a picture's size with one layer per view of a batch. They have four samples per pixel unless the
// comment says otherwise. Optional ones are created when a scene first needs them.
struct RenderTargets {
    gpu::Image depth;
    gpu::Image surfaces;  // geometry buffer: normal, material, grain (shaders/surface.glsl)
    // Optional, the material buffer: base colour and metallic; roughness and occlusion.
    gpu::Image material_colors, material_roughness;
    gpu::Image forward_color;     // optional: parts shaded while drawn
    gpu::Image forward_resolved;  // optional: the same, resolved to one sample
    gpu::Image picture;           // one sample
    gpu::Image kept_depth;        // optional, one sample: depth of the first sample, for readback
    gpu::Image marks;             // optional, one sample: shapes of outlined objects
    gpu::Image small_depth, raw_occlusion, occlusion;  // optional, one sample, half size
    VkExtent2D extent{};
    std::uint32_t layers = 1;  // views of the batch
};

// The stage that runs the passes over the whole picture: ambient occlusion and lighting.
enum class ScreenStage : std::uint8_t { fragment, compute };

// Creates the images that are not optional.
Result<RenderTargets> make_targets(gpu::Device& device, VkExtent2D extent, std::uint32_t layers,
                                   ScreenStage stage);
// Create optional images, unless they exist.
Status add_material_targets(gpu::Device& device, RenderTargets& targets);
Status add_forward_targets(gpu::Device& device, RenderTargets& targets);
Status add_mark_target(gpu::Device& device, RenderTargets& targets);
Status add_occlusion_targets(gpu::Device& device, RenderTargets& targets, ScreenStage stage);
Status add_kept_depth(gpu::Device& device, RenderTargets& targets);

// One layer of an image: the picture of a view.
struct ImageLayer {
    const gpu::Image* image = nullptr;
    std::uint32_t layer = 0;
};

// Counts of the last call of Renderer::render for a group.
struct Statistics {
    std::uint64_t triangles = 0;
    std::uint32_t draws = 0, instances = 0;
    bool static_shadow_redrawn = false;
};

// The render targets of a group of views, kept from frame to frame.
struct ViewGroup {
    std::vector<RenderTargets> targets;             // one per batch
    std::vector<gpu::TransientRange> frame_blocks;  // shared::FrameData of the last frame, one per batch
    VkExtent2D extent{};
    std::uint32_t views = 0, views_per_batch = 1;
    Statistics statistics;

    [[nodiscard]] ImageLayer picture(std::uint32_t view) const {
        return {&targets[view / views_per_batch].picture, view % views_per_batch};
    }
    [[nodiscard]] ImageLayer depth(std::uint32_t view) const {
        return {&targets[view / views_per_batch].kept_depth, view % views_per_batch};
    }
};

// Visits every image of the targets.
template <class Visit>
void each_image(RenderTargets& targets, const Visit& visit) {
    for (gpu::Image* image :
         {&targets.depth, &targets.surfaces, &targets.material_colors, &targets.material_roughness,
          &targets.forward_color, &targets.forward_resolved, &targets.picture, &targets.kept_depth,
          &targets.marks, &targets.small_depth, &targets.raw_occlusion, &targets.occlusion})
        visit(*image);
}

// Pictures are 8-bit sRGB, one layer per view.
inline constexpr VkFormat color_format = VK_FORMAT_R8G8B8A8_SRGB;
// For layers that are blended over a picture; with 8 bits, premultiplied colours would show banding.
inline constexpr VkFormat layer_format = VK_FORMAT_R16G16B16A16_SFLOAT;
// The format in which compute shaders write pictures; they encode sRGB themselves (light.comp).
inline constexpr VkFormat storage_color_format = VK_FORMAT_R8G8B8A8_UNORM;
inline constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat computed_depth_format = VK_FORMAT_R32_SFLOAT;  // depth written by compute shaders
inline constexpr VkFormat surface_format = VK_FORMAT_R16G16B16A16_UNORM;
inline constexpr VkFormat material_color_format = VK_FORMAT_R8G8B8A8_SRGB;
inline constexpr VkFormat material_roughness_format = VK_FORMAT_R8G8_UNORM;
inline constexpr VkFormat occlusion_format = VK_FORMAT_R8_UNORM;
// The format in which compute shaders write occlusion: every GPU supports it for storage images.
inline constexpr VkFormat computed_occlusion_format = VK_FORMAT_R8G8B8A8_UNORM;
inline constexpr VkFormat mark_format = VK_FORMAT_R8G8B8A8_UNORM;
// shade_pixel.glsl depends on this number.
inline constexpr VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_4_BIT;
inline constexpr gpu::ImageRange depth_range{VK_IMAGE_ASPECT_DEPTH_BIT};

// Compiled shaders by file name ("scene.frag").
using Shaders = std::map<std::string, gpu::Shader, std::less<>>;

// The objects that a pass is created from. The cache and the shaders must outlive the pass.
struct PassSetup {
    gpu::Device& device;
    const gpu::PipelineCache& cache;
    const Shaders& shaders;
    ScreenStage screen_stage = ScreenStage::fragment;
};

// State shared by the passes of one frame and one group of views.
struct PassContext {
    gpu::Device& device;
    gpu::FrameContext& frame;
    const Scene& scene;
    const EnvironmentLight& environment;
    shared::FrameData& shared;
    gpu::TransientRange frame_block;  // the uploaded copy of `shared`
    std::uint32_t views;              // number of views of the batch
    VkExtent2D extent;
    gpu::TransientRange instances, materials;  // of the draw list
    const GpuTexture& white;                   // replaces missing maps of a material
    VkImageView white_array;                   // the same texture, viewed as an array
    const DeformedParts& deformed;
    std::span<const Eye> eyes;  // of the views
    float margin;               // RendererOptions::margin, in half widths and half heights of the picture
};

// Uploads values for this frame's shaders. The range is at least as large as one value, because empty ranges
// cannot be bound.
template <class T>
Result<gpu::TransientRange> upload_transient(gpu::FrameContext& frame, std::span<const T> values) {
    Result<gpu::TransientRange> piece = frame.allocate(std::max<std::size_t>(values.size_bytes(), sizeof(T)));
    if (piece && !values.empty()) std::memcpy(piece->bytes.data(), values.data(), values.size_bytes());
    return piece;
}

// Moves the value of a result into `to`.
template <class T>
Status assign(T& to, Result<T> created) {
    if (!created) return fail(created.error());
    to = std::move(*created);
    return {};
}

// Returns the view mask for VkRenderingInfo: 0 without multiview.
std::uint32_t view_mask(std::uint32_t views);
// Configures a pipeline for this number of views.
void set_views(gpu::GraphicsInfo& info, std::uint32_t views);
// A pipeline that blends flat triangles over the picture, without culling and depth. The shaders must outlive
// the result.
gpu::GraphicsInfo over_picture(const Shaders& shaders, const std::string& vertex, const std::string& fragment,
                               std::uint32_t views);
// Draws a triangle that extends beyond the picture, so that the driver must clip it, into a small image with
// two layers; each view writes its own value. Returns true if each layer has the value of its view. Waits for
// the GPU. lavapipe of Mesa 22.3 draws the clipped triangle of the second view into the first layer
// (gallium/auxiliary/draw/draw_pipe_vbuf.c); Mesa 25 does not.
Result<bool> multiview_works(gpu::Device& device, const gpu::PipelineCache& cache);

// Sets viewport and scissor to the whole extent.
void set_area(VkCommandBuffer commands, VkExtent2D extent);

// Binds a descriptor set; for set 0 also the pipeline.
void bind(VkCommandBuffer commands, const gpu::Pipeline& pipeline, VkDescriptorSet set,
          std::uint32_t index = 0);
// Returns whether two draws use the same vertex buffers, which then need to be bound only once.
bool same_geometry(const Draw& a, const Draw& b);
void bind_geometry(VkCommandBuffer commands, const Draw& draw);
void draw(VkCommandBuffer commands, const Draw& draw);

// Draws every part accepted by `wanted` with the bound pipeline.
template <class Wanted>
void draw_all(VkCommandBuffer commands, const DrawList& list, const Wanted& wanted) {
    const Draw* bound = nullptr;
    for (const Draw& d : list.draws) {
        if (!wanted(d)) continue;
        if (bound == nullptr || !same_geometry(*bound, d)) bind_geometry(commands, d);
        bound = &d;
        draw(commands, d);
    }
}

VkRenderingAttachmentInfo attachment(VkImageView view, VkImageLayout layout, VkAttachmentLoadOp load,
                                     VkAttachmentStoreOp store);

// Returns true if an eye has an area that is never seen.
bool has_hidden_area(std::span<const Eye> eyes);

// Returns the rectangle of pixels that the boxes may cover in any of the context's views, widened by
// `margin_px` and by the context's margin, and clamped to the picture.
VkRect2D area_of(const PassContext& context, std::span<const BoundingBox> boxes, float margin_px);

// Returns rendering info for the whole area of the attached images.
VkRenderingInfo rendering_info(VkExtent2D extent, std::uint32_t views,
                               std::span<const VkRenderingAttachmentInfo> colors,
                               const VkRenderingAttachmentInfo* depth = nullptr);

// Draws a rectangle at the far plane over the whole image, with the bound pipeline, which must use
// screen.vert.
void draw_screen(VkCommandBuffer commands);

// Runs a compute pipeline once for each pixel of an image and each view (shaders/compute.glsl).
void dispatch_screen(VkCommandBuffer commands, const gpu::Pipeline& pipeline, VkDescriptorSet set,
                     VkExtent2D extent, std::uint32_t views);

// Describes a pipeline that draws parts with scene.vert; the caller adds the fragment shader and the colour
// formats.
gpu::GraphicsInfo part_pipeline(const Shaders& shaders, const PipelineKind& kind, std::uint32_t views);

// The state with which a pass draws parts.
struct PartDrawing {
    std::function<bool(const PipelineKind&)> wanted;  // false: the part is skipped
    std::function<Result<const gpu::Pipeline*>(const PipelineKind&)> pipeline;
    std::function<Result<VkDescriptorSet>(const gpu::Pipeline&)> frame_set;  // creates descriptor set 0
    std::function<VkRect2D(const PipelineKind&)> area;  // scissor rectangle; empty: the caller's stays set
};

// Draws parts with their materials, in the order of the list. Set 1 holds the maps of a material, and the
// push constant is the index of the material.
Status draw_parts(PassContext& context, const DrawList& list, const PartDrawing& drawing);

}  // namespace bolt::render
