// What the passes of one frame share, and the few commands that all of them record.
#pragma once

#include <cstring>

#include "engine/gpu/barrier.hpp"
#include "engine/gpu/descriptors.hpp"
#include "engine/render/draw_list.hpp"

namespace bolt::render {

// Pictures are 8-bit sRGB, one layer a view.
inline constexpr VkFormat color_format = VK_FORMAT_R8G8B8A8_SRGB;
// Of layers that are laid over a picture: eight bits of a colour times its opacity would show.
inline constexpr VkFormat layer_format = VK_FORMAT_R16G16B16A16_SFLOAT;
inline constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;
inline constexpr VkFormat surface_format = VK_FORMAT_R16G16B16A16_UNORM;
inline constexpr VkFormat wide_color_format = VK_FORMAT_R8G8B8A8_SRGB;
inline constexpr VkFormat wide_rough_format = VK_FORMAT_R8G8_UNORM;
inline constexpr VkFormat occlusion_format = VK_FORMAT_R8_UNORM;
inline constexpr VkFormat mark_format = VK_FORMAT_R8G8B8A8_UNORM;
// light.frag counts on it.
inline constexpr VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_4_BIT;
inline constexpr gpu::ImageRange depth_range{VK_IMAGE_ASPECT_DEPTH_BIT};

// Compiled shaders by file name ("scene.frag").
using Shaders = std::map<std::string, gpu::Shader, std::less<>>;

// What a pass makes its pipelines from. The shaders outlive the pass.
struct PassMaker {
    gpu::Device& device;
    const gpu::PipelineCache& cache;
    const Shaders& shaders;
};

struct PassContext {
    gpu::Device& device;
    gpu::Frame& frame;
    const Scene& scene;
    const EnvironmentLight& environment;
    shared::Frame& shared;
    gpu::Piece frame_block;  // shared, where shaders read it
    std::uint32_t views;     // drawn in one pass
    VkExtent2D extent;
    gpu::Piece instances, materials;  // of the draw list
    const GpuTexture& white;          // in place of maps that a material has not
    VkImageView white_array;
    const DeformedParts& deformed;
};

// Values of this frame for shaders to read; at least room for one, so that nothing is bound empty.
template <class T>
Result<gpu::Piece> put(gpu::Frame& frame, std::span<const T> values) {
    Result<gpu::Piece> piece = frame.piece(std::max<std::size_t>(values.size_bytes(), sizeof(T)));
    if (piece && !values.empty()) std::memcpy(piece->bytes.data(), values.data(), values.size_bytes());
    return piece;
}

// Moves a result to its place.
template <class T>
Status take(T& to, Result<T> made) {
    if (!made) return fail(made.error());
    to = std::move(*made);
    return {};
}

// For VkRenderingInfo: 0 without multiview.
std::uint32_t view_mask(std::uint32_t views);
// A pipeline that draws that many at once.
void draw_views(gpu::GraphicsInfo& info, std::uint32_t views);

// Viewport and scissor: all of it.
void set_area(VkCommandBuffer commands, VkExtent2D extent);

void bind(VkCommandBuffer commands, const gpu::Pipeline& pipeline, VkDescriptorSet set,
          std::uint32_t index = 0);
// Where a draw's vertices are; the next may have them in the same place.
bool same_geometry(const Draw& a, const Draw& b);
void bind_geometry(VkCommandBuffer commands, const Draw& draw);
void draw(VkCommandBuffer commands, const Draw& draw);

// Draws every part that `wanted` takes with the bound pipeline.
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

// The pixels that boxes may cover in any of the context's views, widened by a margin; at most the picture.
VkRect2D area_of(const PassContext& context, std::span<const Box> boxes, float margin_px);

// The whole of an attached image or images.
VkRenderingInfo rendering_info(VkExtent2D extent, std::uint32_t views,
                               std::span<const VkRenderingAttachmentInfo> colors,
                               const VkRenderingAttachmentInfo* depth = nullptr);

// A rectangle as far away as can be, over all of the attached images, drawn with the bound pipeline, which is
// one of screen.vert.
void draw_screen(VkCommandBuffer commands);

}  // namespace bolt::render
