#include "engine/render/renderer.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "engine/gpu/resources.hpp"
#include "engine/render/gpu_layout.hpp"

namespace bolt::render {

namespace {

shared::View view_of(const Eye& eye) {
    return {eye.clip_from_world, glm::inverse(eye.clip_from_world), glm::vec4(eye.position, 1.0F)};
}

shared::FrameData make_frame_data(const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                                  const EnvironmentLight& environment, float level_error_px) {
    shared::FrameData f{};
    for (std::size_t i = 0; i < eyes.size(); ++i) f.views[i] = view_of(eyes[i]);
    const std::size_t lights = std::min<std::size_t>(scene.lights.size(), MAX_LIGHTS);
    for (std::size_t i = 0; i < lights; ++i) f.lights[i] = scene.lights[i].light;
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
    f.shadows = ShadowPass::set_shadow_view(scene, f) ? 1 : 0;
    return f;
}

// Returns the pass for this number of views, and creates it when that number is first drawn.
template <class Pass>
Result<Pass*> pass_for_views(std::map<std::uint32_t, Pass>& passes, const PassSetup& setup,
                             std::uint32_t views) {
    if (const auto known = passes.find(views); known != passes.end()) return &known->second;
    BOLT_TRY_ASSIGN(auto pass, Pass::create(setup, views));
    return &passes.emplace(views, std::move(pass)).first->second;
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(gpu::Device& device, const RendererOptions& options) {
    auto renderer = std::make_unique<Renderer>();
    renderer->device_ = &device;
    renderer->options_ = options;
    BOLT_TRY(renderer->prepare());
    return renderer;
}

Status Renderer::prepare() {
    BOLT_TRY(assign(cache_, gpu::PipelineCache::open(*device_, options_.pipeline_cache)));
    for (const char* name : {"scene.vert",  "light.vert",     "surface.frag", "surface_material.frag",
                             "light.frag",  "scene.frag",     "over.frag",    "mark.vert",
                             "mark.frag",   "outline.frag",   "shadow.vert",  "screen.vert",
                             "shrink.frag", "occlusion.frag", "smooth.frag",  "labels.vert",
                             "labels.frag", "overlay.vert",   "overlay.frag", "deform.comp",
                             "hidden.vert", "panel.vert",     "panel.frag",   "light.comp",
                             "shrink.comp", "occlusion.comp", "smooth.comp"}) {
        BOLT_TRY_ASSIGN(auto shader, load_shader(name, options_.shaders));
        shaders_.insert_or_assign(name, std::move(shader));
    }
    BOLT_TRY(assign(no_environment_,
                    upload_environment(*device_, shading::constant_environment(glm::vec3(0.0F)), 8)));
    BOLT_TRY(assign(white_, plain_texture(*device_, {255, 255, 255, 255})));
    BOLT_TRY(assign(white_array_, white_.image.view(VK_IMAGE_VIEW_TYPE_2D_ARRAY, 0, 1, 0, 1)));
    return make_passes();
}

Status Renderer::make_passes() {
    const PassSetup setup{*device_, cache_, shaders_, options_.screen_stage};
    occlusion_.clear();
    forward_.clear();
    outline_.clear();
    BOLT_TRY(assign(deform_, DeformPass::create(setup)));
    BOLT_TRY(assign(shadow_, ShadowPass::create(setup, options_.shadow_size)));
    BOLT_TRY(assign(surfaces_, SurfacePass::create(setup)));
    BOLT_TRY(assign(light_, LightPass::create(setup)));
    BOLT_TRY(assign(labels_, LabelPass::create(setup)));
    BOLT_TRY(assign(panels_, PanelPass::create(setup)));
    return assign(overlay_, OverlayPass::create(setup));
}

Result<bool> Renderer::draws_views_together() {
    using Multiview = RendererOptions::Multiview;
    if (options_.multiview != Multiview::where_it_works) return options_.multiview == Multiview::always;
    if (!multiview_works_) {
        const Result<bool> works = multiview_works(*device_, cache_);
        if (!works && works.error().lost) return fail(works.error());
        multiview_works_ = works && *works;  // after an error: single views, which need less of the driver
    }
    return *multiview_works_;
}

Status Renderer::resize(gpu::FrameContext& frame, ViewGroup& group, VkExtent2D extent, std::uint32_t views) {
    if (group.extent.width == extent.width && group.extent.height == extent.height && group.views == views)
        return {};
    for (RenderTargets& targets : group.targets)
        each_image(targets, [&](gpu::Image& image) { frame.retire(std::move(image)); });
    group.targets.clear();
    group.views = 0;  // so that a failure below leaves no valid group
    group.views_per_batch = 1;
    if (views > 1) {
        BOLT_TRY_ASSIGN(const bool together, draws_views_together());
        if (together) group.views_per_batch = views;
    }
    for (std::uint32_t first = 0; first < views; first += group.views_per_batch) {
        BOLT_TRY_ASSIGN(auto targets,
                        make_targets(*device_, extent, group.views_per_batch, options_.screen_stage));
        if (options_.keep_depth) BOLT_TRY(add_kept_depth(*device_, targets));
        group.targets.push_back(std::move(targets));
    }
    group.extent = extent;
    group.views = views;
    return {};
}

Status Renderer::render(gpu::FrameContext& frame, const Scene& scene, std::span<const Eye> eyes,
                        VkExtent2D extent, std::uint32_t group_number) {
    if (eyes.empty() || eyes.size() > MAX_VIEWS || extent.width == 0 || extent.height == 0)
        return fail(ErrorCode::failed, "the picture has no pixels, or its number of eyes is wrong",
                    "one to four eyes");
    ViewGroup& group = groups_[group_number];
    BOLT_TRY(resize(frame, group, extent, static_cast<std::uint32_t>(eyes.size())));
    const EnvironmentLight& environment = scene.environment != nullptr ? *scene.environment : no_environment_;
    shared::FrameData shared = make_frame_data(scene, eyes, extent, environment, options_.level_error_px);
    PassContext context{
        *device_, frame, scene,  environment,        shared,          {},   group.views_per_batch, extent,
        {},       {},    white_, white_array_.get(), deform_.parts(), eyes, options_.margin};
    group.frame_blocks.clear();
    const auto upload_frame_data = [&]() -> Status {
        BOLT_TRY(assign(context.frame_block, upload_transient<shared::FrameData>(frame, {&shared, 1})));
        group.frame_blocks.push_back(context.frame_block);
        return {};
    };
    BOLT_TRY(upload_frame_data());

    const PassSetup setup{*device_, cache_, shaders_, options_.screen_stage};
    BOLT_TRY(deform_.draw(context));
    const DrawList list = make_draw_list(
        scene, eyes, {static_cast<float>(extent.height), options_.level_error_px, 0.0F, options_.margin},
        deform_.parts());
    if (list.materials.size() > max_materials)
        return fail(ErrorCode::failed,
                    fmt::format("the scene's models have {} materials", list.materials.size()),
                    fmt::format("at most {}", max_materials));
    BOLT_TRY(assign(context.instances, upload_transient<shared::Instance>(frame, list.instances)));
    BOLT_TRY(assign(context.materials, upload_transient<shared::Material>(frame, list.materials)));

    BOLT_TRY(shadow_.draw(context));
    BOLT_TRY(labels_.prepare(context, eyes));
    LightInputs inputs{&shadow_.map(), VK_NULL_HANDLE};
    for (std::size_t batch = 0; batch < group.targets.size(); ++batch) {
        RenderTargets& targets = group.targets[batch];
        context.eyes = eyes.subspan(batch * group.views_per_batch, group.views_per_batch);
        if (batch > 0) {  // a separate view
            shared.views[0] = view_of(eyes[batch]);
            BOLT_TRY(upload_frame_data());
        }
        BOLT_TRY(surfaces_.draw(context, targets, list));
        if (scene.occlusion_radius > 0.0F) {
            BOLT_TRY_ASSIGN(auto occlusion, pass_for_views(occlusion_, setup, group.views_per_batch));
            BOLT_TRY(occlusion->draw(context, targets));
            inputs.occlusion = targets.occlusion.view();
        }
        BOLT_TRY(light_.draw(context, targets, list, inputs));
        if (!list.forward.empty()) {
            BOLT_TRY_ASSIGN(auto forward, pass_for_views(forward_, setup, group.views_per_batch));
            BOLT_TRY(forward->draw(context, targets, list, light_, inputs));
        }
        if (!list.outlined.empty()) {
            BOLT_TRY_ASSIGN(auto outline, pass_for_views(outline_, setup, group.views_per_batch));
            BOLT_TRY(outline->draw(context, targets, list));
        }
        BOLT_TRY(labels_.draw(context, targets));
        BOLT_TRY(panels_.draw(context, targets));
        gpu::image_barrier(frame.commands(), targets.picture.get(), gpu::ResourceUse::color_target,
                           gpu::ResourceUse::transfer_from);
    }
    group.statistics = {list.triangles, static_cast<std::uint32_t>(list.draws.size()),
                        static_cast<std::uint32_t>(list.instances.size()), shadow_.static_map_redrawn()};
    return {};
}

void Renderer::move_eyes(std::span<const Eye> eyes, std::uint32_t group_number) {
    const ViewGroup& group = groups_.at(group_number);
    for (std::size_t i = 0; i < std::min<std::size_t>(eyes.size(), group.views); ++i) {
        const std::size_t batch = i / group.views_per_batch, view = i % group.views_per_batch;
        const shared::View moved = view_of(eyes[i]);
        std::memcpy(group.frame_blocks[batch].bytes.data() + offsetof(shared::FrameData, views) +
                        view * sizeof(moved),
                    &moved, sizeof(moved));
    }
}

Status Renderer::draw_over(gpu::FrameContext& frame, const Overlay& overlay, const ImageLayer& picture) {
    return overlay_.draw(*device_, frame, overlay, picture, white_array_.get());
}

Rectangle inset_rectangle(VkExtent2D picture, float share) {
    const glm::vec2 size(picture.width, picture.height);
    const glm::vec2 inset = glm::max(glm::round(size * share), 1.0F);
    const glm::vec2 high = size - std::round(0.025F * size.y);
    return {high - inset, high};
}

Status render_with_insets(Renderer& renderer, gpu::FrameContext& frame, const Scene& scene,
                          std::span<const Eye> eyes, VkExtent2D extent, std::span<const Inset> insets) {
    BOLT_TRY(renderer.render(frame, scene, eyes, extent));
    Overlay overlay;
    for (std::uint32_t i = 0; i < insets.size(); ++i) {
        const Inset& inset = insets[i];
        const glm::vec2 size = inset.place.high - inset.place.low;
        const VkExtent2D inset_extent{static_cast<std::uint32_t>(size.x), static_cast<std::uint32_t>(size.y)};
        BOLT_TRY(renderer.render(frame, scene, {&inset.eye, 1}, inset_extent, i + 1));
        add_inset(overlay, inset.place, renderer.picture(0, i + 1), inset.border_px, inset.border);
    }
    for (std::uint32_t view = 0; view < eyes.size(); ++view)
        BOLT_TRY(renderer.draw_over(frame, overlay, renderer.picture(view)));
    return {};
}

Result<std::vector<Picture>> take_pictures(gpu::Device& device, gpu::Frames& frames, Renderer& renderer,
                                           const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                                           std::span<const Inset> insets) {
    BOLT_TRY_ASSIGN(auto frame, frames.begin());
    BOLT_TRY(render_with_insets(renderer, *frame, scene, eyes, extent, insets));
    BOLT_TRY(frames.submit(*frame));
    BOLT_TRY(frames.finish());
    std::vector<Picture> pictures;
    for (std::uint32_t view = 0; view < eyes.size(); ++view) {
        const ImageLayer layer = renderer.picture(view);
        BOLT_TRY_ASSIGN(auto texels, gpu::download_image(device, *layer.image,
                                                         gpu::ResourceUse::transfer_from, 4, 0, layer.layer));
        Picture picture{extent.width, extent.height, std::vector<std::uint8_t>(texels.size())};
        std::memcpy(picture.rgba.data(), texels.data(), texels.size());
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

}  // namespace bolt::render
