#include "engine/render/passes/occlusion.hpp"

namespace bolt::render {

namespace {

template <class Bind>
Result<VkDescriptorSet> make_set(PassContext& context, const gpu::Pipeline& pipeline, const Bind& bind_to) {
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(context.device, context.frame, pipeline, 0);
    if (!writer) return fail(writer.error());
    bind_to(*writer);
    return writer->finish();
}

}  // namespace

Result<OcclusionPass> OcclusionPass::create(const PassMaker& maker, std::uint32_t views) {
    OcclusionPass pass;
    gpu::GraphicsInfo info;
    info.view_mask = view_mask(views);
    info.vertex = &maker.shaders.at("screen.vert");
    info.cull = VK_CULL_MODE_NONE;
    info.depth_test = info.depth_write = false;
    const auto make = [&](gpu::Pipeline& to) {
        return take(to, gpu::make_graphics_pipeline(maker.device, maker.cache, info));
    };
    info.colors = {small_depth_format};
    info.fragment = &maker.shaders.at("shrink.frag");
    if (Status s = make(pass.shrink_); !s) return fail(s.error());
    info.colors = {occlusion_format};
    info.fragment = &maker.shaders.at("occlusion.frag");
    if (Status s = make(pass.slices_); !s) return fail(s.error());
    info.fragment = &maker.shaders.at("smooth.frag");
    if (Status s = make(pass.smooth_); !s) return fail(s.error());
    gpu::SamplerInfo nearest;
    nearest.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    nearest.filter = VK_FILTER_NEAREST;
    if (Status s = take(pass.nearest_, gpu::make_sampler(maker.device, nearest)); !s) return fail(s.error());
    return pass;
}

Status OcclusionPass::draw(PassContext& context, Targets& targets) {
    if (Status made = add_occlusion_targets(context.device, targets); !made) return made;
    const VkSampler nearest = nearest_.get();
    const auto shrink_set = make_set(context, shrink_, [&](gpu::SetWriter& w) {
        w.image(3, targets.depth.view(), nearest, VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL);
    });
    if (!shrink_set) return fail(shrink_set.error());
    const auto slices_set = make_set(context, slices_, [&](gpu::SetWriter& w) {
        w.piece(0, context.frame_block).image(3, targets.small_depth.view(), nearest);
    });
    if (!slices_set) return fail(slices_set.error());
    const auto smooth_set = make_set(context, smooth_, [&](gpu::SetWriter& w) {
        w.image(3, targets.small_depth.view(), nearest).image(4, targets.raw_occlusion.view(), nearest);
    });
    if (!smooth_set) return fail(smooth_set.error());

    context.frame.begin_timing("occlusion");
    fill(context, shrink_, *shrink_set, targets.small_depth);
    fill(context, slices_, *slices_set, targets.raw_occlusion);
    fill(context, smooth_, *smooth_set, targets.occlusion);
    context.frame.end_timing();
    return {};
}

}  // namespace bolt::render
