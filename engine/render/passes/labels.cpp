#include "engine/render/passes/labels.hpp"

namespace bolt::render {

namespace {

using gpu::ResourceUse;

// Room for about 700 Latin letters, or 300 Chinese characters and 100 Latin letters.
constexpr int atlas_size = 1024;
constexpr int largest_atlas = 4096;

Result<gpu::Image> make_image(gpu::Device& device, int size) {
    gpu::ImageInfo info;
    info.format = VK_FORMAT_R16_SFLOAT;
    info.extent = {static_cast<std::uint32_t>(size), static_cast<std::uint32_t>(size)};
    info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    return gpu::Image::create(device, info);
}

}  // namespace

Result<LabelPass> LabelPass::create(const PassMaker& maker) {
    LabelPass pass;
    pass.cache_ = &maker.cache;
    pass.shaders_ = &maker.shaders;
    gpu::SamplerInfo info;
    info.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.smooth_, gpu::make_sampler(maker.device, info)));
    info.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(maker.device, info)));
    return pass;
}

Status LabelPass::load(gpu::Device& device) {
    if (atlas_ != nullptr) return {};
    BOLT_TRY(assign(fonts_, text::load_fonts()));
    BOLT_TRY(assign(image_, make_image(device, atlas_size)));
    atlas_ = std::make_unique<text::Atlas>(atlas_size);
    return {};
}

// If the atlas is full, restart it with this frame's glyphs only; if they do not fit, double its size.
Result<LabelBatch> LabelPass::batch(const Scene& scene, const Eye& eye) {
    for (int size = atlas_->size(); size <= largest_atlas; size *= 2) {
        if (std::optional<LabelBatch> made =
                make_label_batch(scene.labels, eye.clip_from_world, fonts_, *atlas_))
            return std::move(*made);
        atlas_ = std::make_unique<text::Atlas>(size);
        if (std::optional<LabelBatch> made =
                make_label_batch(scene.labels, eye.clip_from_world, fonts_, *atlas_))
            return std::move(*made);
        atlas_ = std::make_unique<text::Atlas>(2 * size);
    }
    atlas_ = std::make_unique<text::Atlas>(atlas_size);  // a smaller one may suffice for the next picture
    return fail(ErrorCode::failed, "the labels of one picture have too many different glyphs");
}

Status LabelPass::upload(PassContext& context) {
    const auto size = static_cast<std::uint32_t>(atlas_->size());
    const text::Atlas::Rows rows = atlas_->take_changed();
    const VkCommandBuffer commands = context.frame.commands();
    if (image_.info().extent.width != size) {
        BOLT_TRY_ASSIGN(auto larger, make_image(context.device, atlas_->size()));
        context.frame.retire(std::exchange(image_, std::move(larger)));
        fresh_ = true;
    }
    if (rows.count == 0) return {};
    const auto first = static_cast<std::size_t>(rows.first), count = static_cast<std::size_t>(rows.count);
    BOLT_TRY_ASSIGN(auto piece, upload_transient<std::uint16_t>(
                                    context.frame, atlas_->texels().subspan(first * size, count * size)));
    gpu::image_barrier(commands, image_.get(), fresh_ ? ResourceUse::undefined : ResourceUse::sampled,
                       ResourceUse::transfer_to);
    VkBufferImageCopy region{};
    region.bufferOffset = piece.offset;
    region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.imageOffset = {0, rows.first, 0};
    region.imageExtent = {size, static_cast<std::uint32_t>(rows.count), 1};
    vkCmdCopyBufferToImage(commands, piece.buffer, image_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &region);
    gpu::image_barrier(commands, image_.get(), ResourceUse::transfer_to, ResourceUse::sampled);
    fresh_ = false;
    return {};
}

Status LabelPass::prepare(PassContext& context, std::span<const Eye> eyes) {
    count_ = 0;
    if (context.scene.labels.empty()) return {};
    BOLT_TRY(load(context.device));
    BOLT_TRY_ASSIGN(auto made, batch(context.scene, eyes.front()));
    if (made.quads.empty()) return {};
    BOLT_TRY(upload(context));
    BOLT_TRY(assign(labels_, upload_transient<shared::LabelFrame>(context.frame, made.labels)));
    BOLT_TRY(assign(quads_, upload_transient<shared::LabelQuad>(context.frame, made.quads)));
    count_ = static_cast<std::uint32_t>(made.quads.size());
    return {};
}

Result<const gpu::Pipeline*> LabelPass::pipeline(gpu::Device& device, std::uint32_t views) {
    if (const auto known = pipelines_.find(views); known != pipelines_.end()) return &known->second;
    gpu::GraphicsInfo info;
    info.vertex = &shaders_->at("labels.vert");
    info.fragment = &shaders_->at("labels.frag");
    info.colors = {color_format};
    draw_views(info, views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    info.blend = true;
    BOLT_TRY_ASSIGN(auto made, gpu::make_graphics_pipeline(device, *cache_, info));
    return &pipelines_.emplace(views, std::move(made)).first->second;
}

Status LabelPass::draw(PassContext& context, const RenderTargets& targets) {
    if (count_ == 0) return {};
    BOLT_TRY_ASSIGN(const auto made, pipeline(context.device, context.views));
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, *made, 0));
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
    bind(commands, *made, set);
    vkCmdDraw(commands, 6 * count_, 1, 0, 0);
    vkCmdEndRendering(commands);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
