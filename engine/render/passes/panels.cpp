#include "engine/render/passes/panels.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace bolt::render {

namespace {

using gpu::ResourceUse;

// Must match shaders/panel.vert.
struct PanelPushConstants {
    glm::vec4 centre{0.0F}, right{0.0F}, up{0.0F};
};

// Panels from far to near, for the eye of the first view.
std::vector<const Panel*> sorted_panels(const PassContext& context) {
    std::vector<const Panel*> panels;
    for (const Panel& panel : context.scene.panels)
        if (panel.picture != nullptr && panel.opacity > 0.0F) panels.push_back(&panel);
    const glm::vec3 eye(context.shared.views[0].eye);
    std::sort(panels.begin(), panels.end(), [&](const Panel* a, const Panel* b) {
        return glm::distance(a->centre, eye) > glm::distance(b->centre, eye);
    });
    return panels;
}

}  // namespace

Result<PanelPicture> PanelPicture::create(gpu::Device& device, VkExtent2D extent) {
    gpu::ImageInfo info;
    info.extent = extent;
    info.array = true;
    info.format = color_format;
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    PanelPicture picture;
    BOLT_TRY(assign(picture.image_, gpu::Image::create(device, info)));
    return picture;
}

void PanelPicture::clear(gpu::FrameContext& frame) {
    const ResourceUse last =
        std::exchange(fresh_, false) ? ResourceUse::undefined : ResourceUse::transfer_from;
    gpu::image_barrier_discarding(frame.commands(), image_.get(), last, ResourceUse::transfer_to);
    const VkClearColorValue transparent{};
    const VkImageSubresourceRange whole{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
    vkCmdClearColorImage(frame.commands(), image_.get(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &transparent,
                         1, &whole);
    gpu::image_barrier(frame.commands(), image_.get(), ResourceUse::transfer_to, ResourceUse::transfer_from);
}

Result<PanelPass> PanelPass::create(const PassSetup& setup) {
    PanelPass pass;
    pass.cache_ = &setup.cache;
    pass.shaders_ = &setup.shaders;
    gpu::SamplerInfo info;
    info.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    BOLT_TRY(assign(pass.smooth_, gpu::make_sampler(setup.device, info)));
    info.filter = VK_FILTER_NEAREST;
    BOLT_TRY(assign(pass.nearest_, gpu::make_sampler(setup.device, info)));
    return pass;
}

Result<const gpu::Pipeline*> PanelPass::pipeline(gpu::Device& device, std::uint32_t views) {
    if (const auto known = pipelines_.find(views); known != pipelines_.end()) return &known->second;
    const gpu::GraphicsInfo info = over_picture(*shaders_, "panel.vert", "panel.frag", views);
    BOLT_TRY_ASSIGN(auto pipeline, gpu::make_graphics_pipeline(device, *cache_, info));
    return &pipelines_.emplace(views, std::move(pipeline)).first->second;
}

Status PanelPass::draw(PassContext& context, const RenderTargets& targets) {
    const std::vector<const Panel*> panels = sorted_panels(context);
    if (panels.empty()) return {};
    BOLT_TRY_ASSIGN(const auto pipeline, this->pipeline(context.device, context.views));
    std::vector<VkDescriptorSet> sets;
    for (const Panel* panel : panels) {
        BOLT_TRY_ASSIGN(auto writer,
                        gpu::DescriptorWriter::create(context.device, context.frame, *pipeline, 0));
        BOLT_TRY_ASSIGN(auto set, writer.range(0, context.frame_block)
                                      .image(1, panel->picture->view(), smooth_.get())
                                      .image(2, targets.depth.view(), nearest_.get(),
                                             VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
                                      .finish());
        sets.push_back(set);
    }
    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("panels");
    for (const Panel* panel : panels)
        gpu::image_barrier(commands, panel->picture->get(), ResourceUse::transfer_from, ResourceUse::sampled);
    gpu::image_barrier(commands, targets.picture.get(), ResourceUse::color_target, ResourceUse::color_target);
    const VkRenderingAttachmentInfo color =
        attachment(targets.picture.view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {&color, 1});
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    for (std::size_t i = 0; i < panels.size(); ++i) {
        bind(commands, *pipeline, sets[i]);
        const PanelPushConstants constants{glm::vec4(panels[i]->centre, 1.0F),
                                           glm::vec4(panels[i]->right, panels[i]->opacity),
                                           glm::vec4(panels[i]->up, 0.0F)};
        vkCmdPushConstants(commands, pipeline->layout.get(), pipeline->push_stages, 0, sizeof constants,
                           &constants);
        vkCmdDraw(commands, 6, 1, 0, 0);
    }
    vkCmdEndRendering(commands);
    for (const Panel* panel : panels)
        gpu::image_barrier(commands, panel->picture->get(), ResourceUse::sampled, ResourceUse::transfer_from);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
