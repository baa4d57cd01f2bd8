#include "engine/render/renderer.hpp"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/render/materials.hpp"

namespace bolt::render {

namespace {

shared::Frame describe(const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                       const EnvironmentLight& environment, float level_error_px) {
    shared::Frame f{};
    for (std::size_t i = 0; i < eyes.size(); ++i) {
        f.views[i].clip_from_world = eyes[i].clip_from_world;
        f.views[i].world_from_clip = glm::inverse(eyes[i].clip_from_world);
        f.views[i].eye = glm::vec4(eyes[i].position, 1.0F);
    }
    f.view_count = static_cast<std::uint32_t>(eyes.size());
    f.light_count = static_cast<std::uint32_t>(std::min<std::size_t>(scene.lights.size(), MAX_LIGHTS));
    for (std::uint32_t i = 0; i < f.light_count; ++i) f.lights[i] = scene.lights[i].light;
    for (std::size_t i = 0; i < environment.diffuse.size(); ++i)
        f.diffuse[i] = glm::vec4(environment.diffuse[i], 0.0F);
    f.environment = {scene.environment_intensity, scene.environment_turn,
                     static_cast<float>(environment.levels.info().mips - 1), scene.exposure};
    const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
    f.picture = {width, height, 1.0F / width, 1.0F / height};
    f.occlusion.x = scene.occlusion_radius;
    const glm::mat4& m = eyes.front().clip_from_world;
    f.occlusion.y = level_error_px * 2.0F / (height * glm::length(glm::vec3(m[0].y, m[1].y, m[2].y)));
    f.background = scene.background;
    f.cut = glm::vec4(scene.cut_away.focus, scene.cut_away.radius);
    f.cut_strength = scene.cut_away.strength;
    f.outline_px = scene.outline_px;
    f.shadows = ShadowPass::describe(scene, f) ? 1 : 0;
    return f;
}

// Passes whose pipelines are made for a number of views, when one is first drawn.
template <class Pass>
Result<Pass*> of_views(std::map<std::uint32_t, Pass>& passes, const PassMaker& maker, std::uint32_t views) {
    if (const auto known = passes.find(views); known != passes.end()) return &known->second;
    Result<Pass> made = Pass::create(maker, views);
    if (!made) return fail(made.error());
    return &passes.emplace(views, std::move(*made)).first->second;
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(gpu::Device& device, const RendererOptions& options) {
    auto renderer = std::make_unique<Renderer>();
    renderer->device_ = &device;
    renderer->options_ = options;
    if (Status done = renderer->prepare(); !done) return fail(done.error());
    return renderer;
}

Status Renderer::prepare() {
    if (Status s = take(cache_, gpu::PipelineCache::open(*device_, options_.pipeline_cache)); !s) return s;
    for (const char* name :
         {"scene.vert", "light.vert", "surface.frag", "light.frag", "scene.frag", "over.frag", "mark.vert",
          "mark.frag", "outline.frag", "shadow.vert", "screen.vert", "shrink.frag", "occlusion.frag",
          "smooth.frag", "labels.vert", "labels.frag", "overlay.vert", "overlay.frag", "deform.comp"}) {
        Result<gpu::Shader> shader = take_shader(name, options_.shaders);
        if (!shader) return fail(shader.error());
        shaders_.insert_or_assign(name, std::move(*shader));
    }
    if (Status s = take(no_environment_, upload_environment(*device_, shading::constant(glm::vec3(0.0F)), 8));
        !s)
        return s;
    if (Status s = take(white_, plain_texture(*device_, {255, 255, 255, 255})); !s) return s;
    if (Status s = take(white_array_, white_.image.view(VK_IMAGE_VIEW_TYPE_2D_ARRAY, 0, 1, 0, 1)); !s)
        return s;
    return make_passes();
}

Status Renderer::make_passes() {
    const PassMaker maker{*device_, cache_, shaders_};
    occlusion_.clear();
    forward_.clear();
    outline_.clear();
    if (Status s = take(deform_, DeformPass::create(maker)); !s) return s;
    if (Status s = take(shadow_, ShadowPass::create(maker, options_.shadow_size)); !s) return s;
    if (Status s = take(surfaces_, SurfacePass::create(maker)); !s) return s;
    if (Status s = take(light_, LightPass::create(maker)); !s) return s;
    if (Status s = take(labels_, LabelPass::create(maker)); !s) return s;
    return take(overlay_, OverlayPass::create(maker));
}

bool Renderer::multiview() const {
    using Multiview = RendererOptions::Multiview;
    if (options_.multiview != Multiview::where_it_works) return options_.multiview == Multiview::always;
    return device_->properties().deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU;
}

Status Renderer::resize(gpu::Frame& frame, ViewGroup& group, VkExtent2D extent, std::uint32_t views) const {
    if (group.extent.width == extent.width && group.extent.height == extent.height && group.views == views)
        return {};
    for (Targets& targets : group.targets)
        each_image(targets, [&](gpu::Image& image) { frame.retire(std::move(image)); });
    group.targets.clear();
    group.views = 0;  // until all is there
    group.views_a_pass = multiview() ? views : 1;
    for (std::uint32_t first = 0; first < views; first += group.views_a_pass) {
        Result<Targets> targets = make_targets(*device_, extent, group.views_a_pass);
        if (!targets) return fail(targets.error());
        if (options_.keep_depth)
            if (Status s = add_kept_depth(*device_, *targets); !s) return s;
        group.targets.push_back(std::move(*targets));
    }
    group.extent = extent;
    group.views = views;
    return {};
}

Status Renderer::render(gpu::Frame& frame, const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                        std::uint32_t group_number) {
    if (eyes.empty() || eyes.size() > MAX_VIEWS || extent.width == 0 || extent.height == 0)
        return fail(ErrorCode::failed, "a picture needs one to four eyes and at least one pixel");
    ViewGroup& group = groups_[group_number];
    if (Status sized = resize(frame, group, extent, static_cast<std::uint32_t>(eyes.size())); !sized)
        return sized;
    const EnvironmentLight& environment = scene.environment != nullptr ? *scene.environment : no_environment_;
    shared::Frame shared = describe(scene, eyes, extent, environment, options_.level_error_px);
    PassContext context{*device_,           frame,  scene, environment, shared, {},
                        group.views_a_pass, extent, {},    {},          white_, white_array_.get(),
                        deform_.parts()};
    const auto put_frame = [&] { return take(context.frame_block, put<shared::Frame>(frame, {&shared, 1})); };
    if (Status s = put_frame(); !s) return s;

    const PassMaker maker{*device_, cache_, shaders_};
    if (Status s = deform_.draw(context); !s) return s;
    const DrawList list = make_draw_list(
        scene, eyes, {static_cast<float>(extent.height), options_.level_error_px, 0.0F}, deform_.parts());
    if (Status s = take(context.instances, put<shared::Instance>(frame, list.instances)); !s) return s;
    if (Status s = take(context.materials, put<shared::Material>(frame, list.materials)); !s) return s;

    if (Status s = shadow_.draw(context); !s) return s;
    if (Status s = labels_.prepare(context, eyes); !s) return s;
    LightInputs inputs{&shadow_.map(), VK_NULL_HANDLE};
    for (std::size_t pass = 0; pass < group.targets.size(); ++pass) {
        Targets& targets = group.targets[pass];
        if (pass > 0) {  // a view of its own
            shared.views[0] = {eyes[pass].clip_from_world, glm::inverse(eyes[pass].clip_from_world),
                               glm::vec4(eyes[pass].position, 1.0F)};
            if (Status s = put_frame(); !s) return s;
        }
        if (Status s = surfaces_.draw(context, targets, list); !s) return s;
        if (scene.occlusion_radius > 0.0F) {
            Result<OcclusionPass*> occluding = of_views(occlusion_, maker, group.views_a_pass);
            if (!occluding) return fail(occluding.error());
            if (Status s = (*occluding)->draw(context, targets); !s) return s;
            inputs.occlusion = targets.occlusion.view();
        }
        if (Status s = light_.draw(context, targets, list, inputs); !s) return s;
        if (!list.forward.empty()) {
            Result<ForwardPass*> forward = of_views(forward_, maker, group.views_a_pass);
            if (!forward) return fail(forward.error());
            if (Status s = (*forward)->draw(context, targets, list, light_, inputs); !s) return s;
        }
        if (!list.outlined.empty()) {
            Result<OutlinePass*> outlining = of_views(outline_, maker, group.views_a_pass);
            if (!outlining) return fail(outlining.error());
            if (Status s = (*outlining)->draw(context, targets, list); !s) return s;
        }
        if (Status s = labels_.draw(context, targets); !s) return s;
        gpu::image_barrier(frame.commands(), targets.picture.get(), gpu::Use::color_target,
                           gpu::Use::transfer_from);
    }
    statistics_ = {list.triangles, static_cast<std::uint32_t>(list.draws.size()),
                   static_cast<std::uint32_t>(list.instances.size()), shadow_.drawn()};
    return {};
}

Status Renderer::draw_over(gpu::Frame& frame, const Overlay& overlay, const Layer& picture) {
    return overlay_.draw(*device_, frame, overlay, picture, white_array_.get());
}

}  // namespace bolt::render
