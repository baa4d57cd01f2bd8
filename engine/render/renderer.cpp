#include "engine/render/renderer.hpp"

#include "engine/gpu/transfer.hpp"
#include "engine/render/materials.hpp"

std::span<const std::uint32_t> scene_shaders(std::string_view name);

namespace bolt::render {

namespace {

constexpr std::uint32_t position_size = sizeof(glm::vec3);

std::uint32_t view_mask(std::uint32_t views) { return views > 1 ? (1U << views) - 1U : 0U; }

template <class T>
Status take(T& to, Result<T> made) {
    if (!made) return fail(made.error());
    to = std::move(*made);
    return {};
}

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(gpu::Device& device, const RendererOptions& options) {
    auto renderer = std::make_unique<Renderer>();
    renderer->device_ = &device;
    renderer->options_ = options;
    if (Status done = renderer->prepare(options); !done) return fail(done.error());
    return renderer;
}

Status Renderer::prepare(const RendererOptions& options) {
    if (Status s = take(cache_, gpu::PipelineCache::open(*device_, options.pipeline_cache)); !s) return s;
    for (const char* name : {"scene.vert", "scene.frag", "shadow.vert", "depth.vert", "screen.vert",
                             "occlusion.frag", "smooth.frag", "sky.vert", "sky.frag"}) {
        Result<gpu::Shader> shader = gpu::make_shader(name, scene_shaders(name));
        if (!shader) return fail(shader.error());
        shaders_.emplace(name, std::move(*shader));
    }
    gpu::GraphicsInfo shadow;
    shadow.vertex = &shaders_.at("shadow.vert");
    shadow.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    shadow.strides = {position_size};
    shadow.depth = depth_format;
    shadow.cull = VK_CULL_MODE_NONE;
    shadow.depth_compare = VK_COMPARE_OP_LESS;
    shadow.depth_clamp = true;
    shadow.depth_bias_slope = 1.5F;
    if (Status s = take(shadow_pipeline_, gpu::make_graphics_pipeline(*device_, cache_, shadow)); !s)
        return s;

    gpu::ImageInfo map;
    map.format = depth_format;
    map.extent = {options.shadow_size, options.shadow_size};
    map.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    if (Status s = take(shadow_map_, gpu::Image::create(*device_, map)); !s) return s;
    const Status readable = gpu::run_now(*device_, [&](VkCommandBuffer commands) {
        gpu::image_barrier(commands, shadow_map_.get(), gpu::Use::undefined, gpu::Use::depth_read,
                           {VK_IMAGE_ASPECT_DEPTH_BIT});
    });
    if (!readable) return readable;
    if (Status s = take(albedo_table_, upload_albedo_table(*device_)); !s) return s;
    if (Status s = take(no_environment_, upload_environment(*device_, shading::constant(glm::vec3(0.0F)), 8));
        !s)
        return s;
    if (Status s = take(white_, plain_texture(*device_, {255, 255, 255, 255})); !s) return s;
    if (Status s = take(white_array_, white_.image.view(VK_IMAGE_VIEW_TYPE_2D_ARRAY, 0, 1, 0, 1)); !s)
        return s;
    gpu::SamplerInfo clamped;
    clamped.address = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    if (Status s = take(clamped_, gpu::make_sampler(*device_, clamped)); !s) return s;
    clamped.filter = VK_FILTER_NEAREST;
    if (Status s = take(nearest_, gpu::make_sampler(*device_, clamped)); !s) return s;
    clamped.filter = VK_FILTER_LINEAR;
    clamped.compares = true;
    return take(comparing_, gpu::make_sampler(*device_, clamped));
}

bool Renderer::multiview() const {
    using Multiview = RendererOptions::Multiview;
    if (options_.multiview != Multiview::where_it_works) return options_.multiview == Multiview::always;
    return device_->properties().deviceType != VK_PHYSICAL_DEVICE_TYPE_CPU;
}

Status Renderer::resize(gpu::Frame& frame, VkExtent2D extent, std::uint32_t views) {
    if (extent_.width == extent.width && extent_.height == extent.height && views_ == views) return {};
    for (Targets& targets : targets_)
        for (gpu::Image* image : {&targets.drawn, &targets.depth, &targets.picture, &targets.small_depth,
                                  &targets.raw_occlusion, &targets.occlusion})
            frame.retire(std::move(*image));
    targets_.clear();
    views_ = 0;  // until all is there
    views_a_pass_ = multiview() ? views : 1;
    for (std::uint32_t first = 0; first < views; first += views_a_pass_) {
        Targets targets;
        gpu::ImageInfo info;
        info.extent = extent;
        info.layers = views_a_pass_;
        info.samples = options_.samples;
        info.format = color_format;
        info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        if (Status s = take(targets.drawn, gpu::Image::create(*device_, info)); !s) return s;
        info.format = depth_format;
        info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        if (Status s = take(targets.depth, gpu::Image::create(*device_, info)); !s) return s;
        info.format = color_format;
        info.samples = VK_SAMPLE_COUNT_1_BIT;
        info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                     VK_IMAGE_USAGE_SAMPLED_BIT;
        if (Status s = take(targets.picture, gpu::Image::create(*device_, info)); !s) return s;
        targets_.push_back(std::move(targets));
    }
    extent_ = extent;
    views_ = views;
    return {};
}

Result<const gpu::Pipeline*> Renderer::scene_pipeline(const Kind& kind, std::uint32_t views) {
    const auto known = scene_pipelines_.find({kind, views});
    if (known != scene_pipelines_.end()) return &known->second;
    gpu::GraphicsInfo info;
    info.vertex = &shaders_.at("scene.vert");
    info.fragment = &shaders_.at("scene.frag");
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0},
                    {1, VK_FORMAT_R16G16B16A16_SNORM, 1, offsetof(VertexAttributes, normal)},
                    {2, VK_FORMAT_R16G16B16A16_SNORM, 1, offsetof(VertexAttributes, tangent)},
                    {3, VK_FORMAT_R32G32_SFLOAT, 1, offsetof(VertexAttributes, texcoord)},
                    {4, VK_FORMAT_R8G8B8A8_UNORM, 1, offsetof(VertexAttributes, color)}};
    info.strides = {position_size, sizeof(VertexAttributes)};
    info.colors = {color_format};
    info.depth = depth_format;
    info.samples = options_.samples;
    info.view_mask = view_mask(views);
    info.cull = kind.double_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    info.blend = kind.blends;
    info.depth_write = !kind.blends;
    info.constants = (kind.textured ? SCENE_TEXTURED : 0U) | (kind.colors ? SCENE_VERTEX_COLORS : 0U);
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(*device_, cache_, info);
    if (!made) return fail(made.error());
    return &scene_pipelines_.emplace(std::pair{kind, views}, std::move(*made)).first->second;
}

Result<const gpu::Pipeline*> Renderer::sky_pipeline(std::uint32_t views) {
    const auto known = sky_pipelines_.find(views);
    if (known != sky_pipelines_.end()) return &known->second;
    gpu::GraphicsInfo info;
    info.vertex = &shaders_.at("sky.vert");
    info.fragment = &shaders_.at("sky.frag");
    info.colors = {color_format};
    info.depth = depth_format;
    info.samples = options_.samples;
    info.view_mask = view_mask(views);
    info.cull = VK_CULL_MODE_NONE;
    info.depth_write = false;
    Result<gpu::Pipeline> made = gpu::make_graphics_pipeline(*device_, cache_, info);
    if (!made) return fail(made.error());
    return &sky_pipelines_.emplace(views, std::move(*made)).first->second;
}

Status Renderer::make_occlusion_targets(Targets& targets) {
    if (targets.occlusion.get() != VK_NULL_HANDLE) return {};
    gpu::ImageInfo info;
    info.extent = {(extent_.width + 1) / 2, (extent_.height + 1) / 2};
    info.layers = views_a_pass_;
    info.array = true;
    info.format = depth_format;
    info.usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    if (Status s = take(targets.small_depth, gpu::Image::create(*device_, info)); !s) return s;
    info.format = occlusion_format;
    info.usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    if (Status s = take(targets.raw_occlusion, gpu::Image::create(*device_, info)); !s) return s;
    return take(targets.occlusion, gpu::Image::create(*device_, info));
}

Result<const Renderer::OcclusionPipelines*> Renderer::occlusion_pipelines(std::uint32_t views) {
    const auto known = occlusion_pipelines_.find(views);
    if (known != occlusion_pipelines_.end()) return &known->second;
    OcclusionPipelines made;
    gpu::GraphicsInfo info;
    info.view_mask = view_mask(views);
    info.vertex = &shaders_.at("depth.vert");
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {position_size};
    info.depth = depth_format;
    info.cull = VK_CULL_MODE_NONE;
    if (Status s = take(made.depth, gpu::make_graphics_pipeline(*device_, cache_, info)); !s)
        return fail(s.error());
    info.vertex = &shaders_.at("screen.vert");
    info.streams.clear();
    info.strides.clear();
    info.depth = VK_FORMAT_UNDEFINED;
    info.depth_test = info.depth_write = false;
    info.colors = {occlusion_format};
    info.fragment = &shaders_.at("occlusion.frag");
    if (Status s = take(made.slices, gpu::make_graphics_pipeline(*device_, cache_, info)); !s)
        return fail(s.error());
    info.fragment = &shaders_.at("smooth.frag");
    if (Status s = take(made.smooth, gpu::make_graphics_pipeline(*device_, cache_, info)); !s)
        return fail(s.error());
    return &occlusion_pipelines_.emplace(views, std::move(made)).first->second;
}

}  // namespace bolt::render
