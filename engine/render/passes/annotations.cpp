#include "engine/render/passes/annotations.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "engine/text/layout.hpp"

namespace bolt::render {

using gpu::ResourceUse;

Result<OutlinePass> OutlinePass::create(const PassSetup& setup, std::uint32_t views) {
    OutlinePass pass;
    gpu::GraphicsInfo info;
    set_views(info, views);
    info.depth_test = info.depth_write = false;
    info.cull = VK_CULL_MODE_NONE;
    info.colors = {mark_format};
    info.vertex = &setup.shaders.at("mark.vert");
    info.fragment = &setup.shaders.at("mark.frag");
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {sizeof(glm::vec3)};
    BOLT_TRY(assign(pass.marks_, gpu::make_graphics_pipeline(setup.device, setup.cache, info)));
    info.vertex = &setup.shaders.at("screen.vert");
    info.fragment = &setup.shaders.at("outline.frag");
    info.streams.clear();
    info.strides.clear();
    info.colors = {color_format};
    info.blend = true;
    BOLT_TRY(assign(pass.lines_, gpu::make_graphics_pipeline(setup.device, setup.cache, info)));
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.clamped_, gpu::make_sampler(setup.device, clamped)));
    return pass;
}

Status OutlinePass::draw_marks(PassContext& context, const RenderTargets& targets, const DrawList& list) {
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, marks_, 0));
    BOLT_TRY_ASSIGN(const auto set,
                    writer.range(0, context.frame_block).range(1, context.instances).finish());
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier_discarding(commands, targets.marks.get(), ResourceUse::sampled,
                                  ResourceUse::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.marks.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    bind(commands, marks_, set);
    draw_all(commands, list, [](const Draw& d) { return d.outlined; });
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, targets.marks.get(), ResourceUse::color_target, ResourceUse::sampled);
    return {};
}

Status OutlinePass::draw(PassContext& context, RenderTargets& targets, const DrawList& list) {
    const VkRect2D area = area_of(context, list.outlined, context.shared.outline_px + 1.0F);
    if (area.extent.width == 0 || area.extent.height == 0) return {};
    BOLT_TRY(add_mark_target(context.device, targets));
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, lines_, 0));
    BOLT_TRY_ASSIGN(
        const auto set,
        writer.range(0, context.frame_block).image(3, targets.marks.view(), clamped_.get()).finish());
    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("outline");
    BOLT_TRY(draw_marks(context, targets, list));
    gpu::image_barrier(commands, targets.picture.get(), ResourceUse::color_target, ResourceUse::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    rendering.renderArea = area;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    vkCmdSetScissor(commands, 0, 1, &area);
    bind(commands, lines_, set);
    draw_screen(commands);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return {};
}

namespace {

// Decodes an sRGB component (IEC 61966-2-1).
float linear(float encoded) {
    return encoded <= 0.04045F ? encoded / 12.92F : std::pow((encoded + 0.055F) / 1.055F, 2.4F);
}

// The same for a colour; alpha is not encoded.
glm::vec4 linear(const glm::vec4& encoded) {
    return {linear(encoded.r), linear(encoded.g), linear(encoded.b), encoded.a};
}

static_assert(sizeof(shared::LabelFrame) == 64 && sizeof(shared::LabelQuad) == 64);
static_assert(offsetof(shared::LabelQuad, grow) == 48);

constexpr glm::vec2 plate_margin(0.35F, 0.15F);  // of the background around the text, em
constexpr float plate_corner_radius = 0.3F;      // em

shared::LabelFrame frame_of(const Label& label) {
    shared::LabelFrame frame{};
    const float placement = label.placement == LabelPlacement::fixed    ? LABEL_FIXED
                            : label.placement == LabelPlacement::facing ? LABEL_FACING
                                                                        : LABEL_ON_SCREEN;
    frame.position = glm::vec4(label.position, label.height);
    frame.right = glm::vec4(label.orientation * glm::vec3(1, 0, 0), placement);
    frame.up =
        glm::vec4(label.orientation * glm::vec3(0, 1, 0), std::clamp(label.occluded_visibility, 0.0F, 1.0F));
    frame.pixels = glm::vec4(label.offset_px, label.occlusion_margin, 0.0F);
    return frame;
}

shared::LabelQuad plate_of(const Label& label, const glm::vec2& low, const glm::vec2& size) {
    shared::LabelQuad quad{};
    const glm::vec2 half = 0.5F * size + plate_margin, middle = low + 0.5F * size;
    // The quad is slightly larger than the background, whose edge is smoothed over one pixel.
    const glm::vec2 quad_half = half + static_cast<float>(text::Atlas::reach);
    quad.rect = glm::vec4(middle - quad_half, middle + quad_half);
    quad.uv = glm::vec4(half, half);
    quad.color = linear(label.plate);
    quad.grow = plate_corner_radius;
    quad.plate = 1;
    return quad;
}

}  // namespace

std::optional<LabelBatch> make_label_batch(std::span<const Label> labels, const glm::mat4& clip_from_world,
                                           const text::Fonts& fonts, text::Atlas& atlas) {
    std::vector<std::size_t> order(labels.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto distance = [&](std::size_t i) {
        return (clip_from_world * glm::vec4(labels[i].position, 1.0F)).w;
    };
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return distance(a) > distance(b); });
    LabelBatch batch;
    for (const std::size_t i : order) {
        const Label& label = labels[i];
        const text::TextLayout layout = text::lay_out(fonts, label.text, label.anchor.x);
        if (layout.glyphs.empty()) continue;
        const glm::vec2 low = -label.anchor * layout.size;
        const auto add = [&](shared::LabelQuad quad) {
            quad.label = static_cast<std::uint32_t>(batch.labels.size());
            batch.quads.push_back(quad);
        };
        if (label.plate.a > 0.0F) add(plate_of(label, low, layout.size));
        const auto add_glyphs = [&](const glm::vec4& color, float grow) {
            for (const text::PlacedGlyph& placed : layout.glyphs) {
                const text::AtlasGlyph* glyph = atlas.glyph(fonts, placed.id);
                if (glyph == nullptr) return false;
                if (glyph->low == glyph->high) continue;
                const glm::vec2 at = low + placed.at;
                shared::LabelQuad quad{};
                quad.rect = glm::vec4(at + glyph->low, at + glyph->high);
                quad.uv = glm::vec4(glyph->uv_low, glyph->uv_high);
                quad.color = linear(color);
                quad.grow = grow;
                add(quad);
            }
            return true;
        };
        // All outlines come first, so that a glyph's outline does not cover the previous glyph.
        if (label.outline.a > 0.0F && !add_glyphs(label.outline, std::clamp(label.outline_width, 0.0F, 0.1F)))
            return std::nullopt;
        if (!add_glyphs(label.color, 0.0F)) return std::nullopt;
        batch.labels.push_back(frame_of(label));
    }
    return batch;
}

namespace {

// Texels a side: room for about 700 Latin letters, or 300 Chinese characters and 100 Latin letters.
constexpr int atlas_size = 1024;
constexpr int max_atlas_size = 4096;

Result<gpu::Image> make_image(gpu::Device& device, int size) {
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R16_SFLOAT;
    info.extent = {static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(size)};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return gpu::Image::create(device, info);
}

}  // namespace

Result<LabelPass> LabelPass::create(const PassSetup& setup) {
    LabelPass pass;
    pass.cache_ = &setup.cache;
    pass.shaders_ = &setup.shaders;
    gpu::SamplerInfo info;
    info.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.smooth_, gpu::make_sampler(setup.device, info)));
    info.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(setup.device, info)));
    return pass;
}

Status LabelPass::load(gpu::Device& device) {
    if (atlas_ != nullptr) return {};
    BOLT_TRY(assign(fonts_, text::load_fonts()));
    BOLT_TRY(assign(image_, make_image(device, atlas_size)));
    atlas_ = std::make_unique<text::Atlas>(atlas_size);
    return {};
}

// If the atlas is full, restarts it with this frame's glyphs only; if they do not fit, doubles its size.
Result<LabelBatch> LabelPass::batch(const Scene& scene, const Eye& eye) {
    for (int size = atlas_->size(); size <= max_atlas_size; size *= 2) {
        if (std::optional<LabelBatch> label_batch =
                make_label_batch(scene.labels, eye.clip_from_world, fonts_, *atlas_))
            return std::move(*label_batch);
        atlas_ = std::make_unique<text::Atlas>(size);
        if (std::optional<LabelBatch> label_batch =
                make_label_batch(scene.labels, eye.clip_from_world, fonts_, *atlas_))
            return std::move(*label_batch);
        atlas_ = std::make_unique<text::Atlas>(2 * size);
    }
    atlas_ = std::make_unique<text::Atlas>(atlas_size);  // a smaller one may suffice for the next picture
    return fail(ErrorCode::failed, "the labels of one picture have too many different glyphs",
                "labels with fewer different characters");
}

Status LabelPass::upload(PassContext& context) {
    const auto size = static_cast<std::uint32_t>(atlas_->size());
    const text::Atlas::RowRange rows = atlas_->take_changed_rows();
    const VkCommandBuffer commands = context.frame.commands();
    if (image_.info().extent.width != size) {
        BOLT_TRY_ASSIGN(auto larger, make_image(context.device, atlas_->size()));
        context.frame.retire(std::exchange(image_, std::move(larger)));
        fresh_ = true;
    }
    if (rows.count == 0) return {};
    const auto first = static_cast<std::size_t>(rows.first), count = static_cast<std::size_t>(rows.count);
    BOLT_TRY_ASSIGN(auto range, upload_transient<std::uint16_t>(
                                    context.frame, atlas_->texels().subspan(first * size, count * size)));
    gpu::image_barrier(commands, image_.get(), fresh_ ? ResourceUse::undefined : ResourceUse::sampled,
                       ResourceUse::transfer_to);
    VkBufferImageCopy region{};
    region.bufferOffset = range.offset;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageOffset = {0, rows.first, 0};
    region.imageExtent = {size, static_cast<std::uint32_t>(rows.count), 1};
    vkCmdCopyBufferToImage(commands, range.buffer, image_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &region);
    gpu::image_barrier(commands, image_.get(), ResourceUse::transfer_to, ResourceUse::sampled);
    fresh_ = false;
    return {};
}

Status LabelPass::prepare(PassContext& context, std::span<const Eye> eyes) {
    count_ = 0;
    if (context.scene.labels.empty()) return {};
    BOLT_TRY(load(context.device));
    BOLT_TRY_ASSIGN(auto label_batch, batch(context.scene, eyes.front()));
    if (label_batch.quads.empty()) return {};
    BOLT_TRY(upload(context));
    BOLT_TRY(assign(labels_, upload_transient<shared::LabelFrame>(context.frame, label_batch.labels)));
    BOLT_TRY(assign(quads_, upload_transient<shared::LabelQuad>(context.frame, label_batch.quads)));
    count_ = static_cast<std::uint32_t>(label_batch.quads.size());
    return {};
}

Result<const gpu::Pipeline*> LabelPass::pipeline(gpu::Device& device, std::uint32_t views) {
    if (const auto known = pipelines_.find(views); known != pipelines_.end()) return &known->second;
    const gpu::GraphicsInfo info = over_picture(*shaders_, "labels.vert", "labels.frag", views);
    BOLT_TRY_ASSIGN(auto pipeline, gpu::make_graphics_pipeline(device, *cache_, info));
    return &pipelines_.emplace(views, std::move(pipeline)).first->second;
}

Status LabelPass::draw(PassContext& context, const RenderTargets& targets) {
    if (count_ == 0) return {};
    BOLT_TRY_ASSIGN(const auto pipeline, this->pipeline(context.device, context.views));
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, *pipeline, 0));
    BOLT_TRY_ASSIGN(const auto set, writer.range(0, context.frame_block)
                                        .range(1, labels_)
                                        .range(2, quads_)
                                        .image(3, image_.view(), smooth_.get())
                                        .image(4, targets.depth.view(), nearest_.get(),
                                               VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
                                        .finish());
    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("labels");
    gpu::image_barrier(commands, targets.picture.get(), ResourceUse::color_target, ResourceUse::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    bind(commands, *pipeline, set);
    vkCmdDraw(commands, 6 * count_, 1, 0, 0);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
