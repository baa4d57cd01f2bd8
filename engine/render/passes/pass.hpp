// State and commands shared by the passes of a frame.
#pragma once

#include <cstring>

#include "engine/gpu/barrier.hpp"
#include "engine/gpu/descriptors.hpp"
#include "engine/render/draw_list.hpp"

namespace bolt::render {

// Pictures are 8-bit sRGB, one layer per view.
inline constexpr VkFormat color_format = VK_FORMAT_R8G8B8A8_SRGB;
// For layers that are blended over a picture; with 8 bits, premultiplied colours would show banding.
inline constexpr VkFormat layer_format = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat surface_format = VK_FORMAT_R16G16B16A16_UNORM;
inline constexpr VkFormat wide_color_format = VK_FORMAT_R8G8B8A8_SRGB;
inline constexpr VkFormat wide_rough_format = VK_FORMAT_R8G8_UNORM;
inline constexpr VkFormat occlusion_format = VK_FORMAT_R8_UNORM;
inline constexpr VkFormat mark_format = VK_FORMAT_R8G8B8A8_UNORM;
// light.frag assumes this number.
inline constexpr VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_4_BIT;
inline constexpr gpu::ImageRange depth_range{VK_IMAGE_ASPECT_DEPTH_BIT};

// Compiled shaders by file name ("scene.frag").
using Shaders = std::map<std::string, gpu::Shader, std::less<>>;

// The inputs for creating a pass. The shaders outlive the pass.
struct PassMaker {
    gpu::Device& device;
    const gpu::PipelineCache& cache;
    const Shaders& shaders;
};

struct PassContext {
    gpu::Device& device;
    gpu::FrameContext& frame;
    const Scene& scene;
    const EnvironmentLight& environment;
    shared::FrameData& shared;
    gpu::TransientRange frame_block;  // the uploaded copy of `shared`
    std::uint32_t views;              // drawn in one pass
    VkExtent2D extent;
    gpu::TransientRange instances, materials;  // of the draw list
    const GpuTexture& white;                   // replaces missing maps of a material
    VkImageView white_array;
    const DeformedParts& deformed;
};

// Uploads values for this frame's shaders; the range has room for at least one value, because empty ranges
// cannot be bound.
template <class T>
Result<gpu::TransientRange> upload_transient(gpu::FrameContext& frame, std::span<const T> values) {
    Result<gpu::TransientRange> piece = frame.allocate(std::max<std::size_t>(values.size_bytes(), sizeof(T)));
    if (piece && !values.empty()) std::memcpy(piece->bytes.data(), values.data(), values.size_bytes());
    return piece;
}

// Moves the value of a result into `to`.
template <class T>
Status assign(T& to, Result<T> made) {
    if (!made) return fail(made.error());
    to = std::move(*made);
    return {};
}

// The view mask for VkRenderingInfo: 0 without multiview.
std::uint32_t view_mask(std::uint32_t views);
// Configures a pipeline for this number of views.
void draw_views(gpu::GraphicsInfo& info, std::uint32_t views);

// Sets viewport and scissor to the whole extent.
void set_area(VkCommandBuffer commands, VkExtent2D extent);

void bind(VkCommandBuffer commands, const gpu::Pipeline& pipeline, VkDescriptorSet set,
          std::uint32_t index = 0);
// Whether two draws use the same vertex buffers; then they need to be bound only once.
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

// The pixels that the boxes may cover in any of the context's views, widened by a margin and clamped to the
// picture.
VkRect2D area_of(const PassContext& context, std::span<const BoundingBox> boxes, float margin_px);

// Rendering info that covers the whole of the attached images.
VkRenderingInfo rendering_info(VkExtent2D extent, std::uint32_t views,
                               std::span<const VkRenderingAttachmentInfo> colors,
                               const VkRenderingAttachmentInfo* depth = nullptr);

// Draws a rectangle at the far plane over the whole image, with the bound pipeline, which must use
// screen.vert.
void draw_screen(VkCommandBuffer commands);

}  // namespace bolt::render
