#include <glm/gtc/type_ptr.hpp>
#include <glm/matrix.hpp>

#include <cstring>

#include "engine/gpu/barrier.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/shadow_view.hpp"

namespace bolt::render {

namespace {

using gpu::Use;

constexpr gpu::ImageRange depth_range{VK_IMAGE_ASPECT_DEPTH_BIT};

shared::Frame describe(const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent,
                       const EnvironmentLight& environment) {
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
    f.background = scene.background;
    const bool shades = !scene.lights.empty() && scene.lights.front().casts_shadow &&
                        scene.lights.front().light.position.w == 0.0F && !scene.objects.empty();
    f.shadows = shades ? 1 : 0;
    if (shades)
        f.shadow_from_world = shadow_view(bounds(scene), glm::vec3(scene.lights.front().light.direction));
    return f;
}

// FNV-1a over everything that the shadow map shows.
std::uint64_t shadow_key(const Scene& scene, const shared::Frame& f) {
    std::uint64_t key = 14695981039346656037ULL;
    const auto add = [&](const void* data, std::size_t size) {
        const auto* bytes = static_cast<const unsigned char*>(data);
        for (std::size_t i = 0; i < size; ++i) key = (key ^ bytes[i]) * 1099511628211ULL;
    };
    add(&f.shadow_from_world, sizeof f.shadow_from_world);
    for (const Object& object : scene.objects) {
        if (object.opacity < 1.0F || object.flat) continue;
        add(&object.model, sizeof object.model);
        add(&object.mesh, sizeof object.mesh);
        add(glm::value_ptr(object.world), sizeof object.world);
    }
    return key != 0 ? key : 1;
}

template <class T>
Result<gpu::Piece> put(gpu::Frame& frame, std::span<const T> values) {
    Result<gpu::Piece> piece = frame.piece(std::max<std::size_t>(values.size_bytes(), sizeof(T)));
    if (piece) std::memcpy(piece->bytes.data(), values.data(), values.size_bytes());
    return piece;
}

// As shaders/tone.glsl has it.
glm::vec3 pbr_neutral(glm::vec3 color) {
    constexpr float start = 0.8F - 0.04F, d = 1.0F - start;
    const float x = std::min({color.r, color.g, color.b});
    color -= x < 0.08F ? x - 6.25F * x * x : 0.04F;
    const float peak = std::max({color.r, color.g, color.b});
    if (peak < start) return color;
    const float new_peak = 1.0F - d * d / (peak + d - start);
    const float grey = 1.0F - 1.0F / (0.15F * (peak - new_peak) + 1.0F);
    return glm::mix(color * (new_peak / peak), glm::vec3(new_peak), grey);
}

void set_area(VkCommandBuffer commands, VkExtent2D extent) {
    const VkViewport viewport{0.0F, 0.0F, static_cast<float>(extent.width), static_cast<float>(extent.height),
                              0.0F, 1.0F};
    const VkRect2D scissor{{0, 0}, extent};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

void bind_geometry(VkCommandBuffer commands, const GpuModel& model) {
    const VkBuffer buffers[] = {model.positions.get(), model.attributes.get()};
    const VkDeviceSize offsets[] = {0, 0};
    vkCmdBindVertexBuffers(commands, 0, 2, buffers, offsets);
    vkCmdBindIndexBuffer(commands, model.indices.get(), 0, VK_INDEX_TYPE_UINT32);
}

void draw(VkCommandBuffer commands, const Draw& d) {
    const Part& part = d.model->parts[d.part];
    vkCmdDrawIndexed(commands, part.index_count, d.instances, part.first_index, part.first_vertex,
                     d.first_instance);
}

}  // namespace

// What the passes of one frame share.
struct Renderer::Passes {
    Renderer& renderer;
    gpu::Frame& frame;
    const Scene& scene;
    const EnvironmentLight& environment;
    shared::Frame shared;
    std::uint32_t views;  // drawn in one pass
    gpu::Piece frame_block{};
    VkImageView occlusion_view = VK_NULL_HANDLE;  // what the scene reads

    Status put_frame();
    Status shadow();
    Status picture(const DrawList& list);
    Status occlusion(Targets& target, const DrawList& list, const gpu::Piece& instances);

  private:
    Result<VkDescriptorSet> frame_set(const gpu::Pipeline& pipeline, const gpu::Piece& instances,
                                      const gpu::Piece& materials);
    Status fill(const gpu::Pipeline& pipeline, VkDescriptorSet set, const gpu::Image& target);
    Result<VkDescriptorSet> texture_set(const gpu::Pipeline& pipeline, const GpuModel& model,
                                        std::uint32_t material);
    Status draw_scene(const DrawList& list, const gpu::Piece& instances, const gpu::Piece& materials);
    Status draw_sky();
    Status draw_into(const Targets& target, const DrawList& list, const gpu::Piece& instances,
                     const gpu::Piece& materials);
};

Status Renderer::render(gpu::Frame& frame, const Scene& scene, std::span<const Eye> eyes, VkExtent2D extent) {
    if (eyes.empty() || eyes.size() > MAX_VIEWS || extent.width == 0 || extent.height == 0)
        return fail(ErrorCode::failed, "a picture needs one to four eyes and at least one pixel");
    if (Status sized = resize(frame, extent, static_cast<std::uint32_t>(eyes.size())); !sized) return sized;
    const EnvironmentLight& environment = scene.environment != nullptr ? *scene.environment : no_environment_;
    Passes passes{*this,        frame, scene, environment, describe(scene, eyes, extent, environment),
                  views_a_pass_};
    if (Status put = passes.put_frame(); !put) return put;
    const DrawList list = make_draw_list(scene, eyes);
    statistics_ = {list.triangles, static_cast<std::uint32_t>(list.draws.size()),
                   static_cast<std::uint32_t>(list.instances.size()), false};
    if (Status done = passes.shadow(); !done) return done;
    return passes.picture(list);
}

Status Renderer::Passes::put_frame() {
    Result<gpu::Piece> block = put<shared::Frame>(frame, {&shared, 1});
    if (!block) return fail(block.error());
    frame_block = *block;
    return {};
}

Status Renderer::Passes::shadow() {
    if (shared.shadows == 0) return {};
    const std::uint64_t key = shadow_key(scene, shared);
    if (key == renderer.shadow_key_) return {};
    renderer.shadow_key_ = key;
    renderer.statistics_.shadow_drawn = true;
    Scene casters;
    for (const Object& object : scene.objects)
        if (object.opacity >= 1.0F && !object.flat) casters.objects.push_back(object);
    const DrawList list = make_draw_list(casters, {});
    Result<gpu::Piece> instances = put<shared::Instance>(frame, list.instances);
    if (!instances) return fail(instances.error());
    Result<gpu::SetWriter> writer =
        gpu::SetWriter::create(*renderer.device_, frame, renderer.shadow_pipeline_, 0);
    if (!writer) return fail(writer.error());
    Result<VkDescriptorSet> set = writer->piece(0, frame_block).piece(1, *instances).finish();
    if (!set) return fail(set.error());

    const VkCommandBuffer commands = frame.commands();
    const gpu::Image& map = renderer.shadow_map_;
    frame.begin_timing("shadow");
    gpu::image_barrier_discarding(commands, map.get(), Use::depth_read, Use::depth_target, depth_range);
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = map.view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    depth.clearValue.depthStencil.depth = 1.0F;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = map.info().extent;
    rendering.layerCount = 1;
    rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, map.info().extent);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer.shadow_pipeline_.handle.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer.shadow_pipeline_.layout.get(),
                            0, 1, &*set, 0, nullptr);
    const GpuModel* bound = nullptr;
    for (const Draw& d : list.draws) {
        if (std::exchange(bound, d.model) != d.model) bind_geometry(commands, *d.model);
        draw(commands, d);
    }
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, map.get(), Use::depth_target, Use::depth_read, depth_range);
    frame.end_timing();
    return {};
}

Result<VkDescriptorSet> Renderer::Passes::frame_set(const gpu::Pipeline& pipeline,
                                                    const gpu::Piece& instances,
                                                    const gpu::Piece& materials) {
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(*renderer.device_, frame, pipeline, 0);
    if (!writer) return fail(writer.error());
    const VkSampler clamped = renderer.clamped_.get();
    return writer->piece(0, frame_block)
        .piece(1, instances)
        .piece(2, materials)
        .image(3, renderer.albedo_table_.view(), clamped)
        .image(4, environment.levels.view(), clamped)
        .image(5, renderer.shadow_map_.view(), renderer.comparing_.get(),
               VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL)
        .image(6, occlusion_view, clamped)
        .finish();
}

Result<VkDescriptorSet> Renderer::Passes::texture_set(const gpu::Pipeline& pipeline, const GpuModel& model,
                                                      std::uint32_t material) {
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(*renderer.device_, frame, pipeline, 1);
    if (!writer) return fail(writer.error());
    const MaterialMaps& maps = model.maps[material];
    for (std::uint32_t i = 0; i < maps.textures.size(); ++i) {
        const GpuTexture& texture = maps.textures[i] >= 0
                                        ? model.textures[static_cast<std::size_t>(maps.textures[i])]
                                        : renderer.white_;
        writer->image(i, texture.image.view(), texture.sampler.get());
    }
    return writer->finish();
}

Status Renderer::Passes::draw_scene(const DrawList& list, const gpu::Piece& instances,
                                    const gpu::Piece& materials) {
    const VkCommandBuffer commands = frame.commands();
    const gpu::Pipeline* pipeline = nullptr;
    const GpuModel* bound = nullptr;
    const MaterialMaps* maps = nullptr;
    for (const Draw& d : list.draws) {
        Result<const gpu::Pipeline*> wanted = renderer.scene_pipeline(d.kind, views);
        if (!wanted) return fail(wanted.error());
        if (std::exchange(pipeline, *wanted) != *wanted) {
            Result<VkDescriptorSet> set = frame_set(*pipeline, instances, materials);
            if (!set) return fail(set.error());
            vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->handle.get());
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->layout.get(), 0, 1,
                                    &*set, 0, nullptr);
            maps = nullptr;
        }
        const std::uint32_t material = d.model->parts[d.part].material;
        const MaterialMaps& needed = d.model->maps[material];
        if (maps == nullptr || (maps != &needed && maps->textures != needed.textures) || bound != d.model) {
            Result<VkDescriptorSet> set = texture_set(*pipeline, *d.model, material);
            if (!set) return fail(set.error());
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline->layout.get(), 1, 1,
                                    &*set, 0, nullptr);
            maps = &needed;
        }
        if (std::exchange(bound, d.model) != d.model) bind_geometry(commands, *d.model);
        draw(commands, d);
    }
    return {};
}

Status Renderer::Passes::draw_sky() {
    Result<const gpu::Pipeline*> pipeline = renderer.sky_pipeline(views);
    if (!pipeline) return fail(pipeline.error());
    Result<gpu::SetWriter> writer = gpu::SetWriter::create(*renderer.device_, frame, **pipeline, 0);
    if (!writer) return fail(writer.error());
    Result<VkDescriptorSet> set =
        writer->piece(0, frame_block).image(4, environment.levels.view(), renderer.clamped_.get()).finish();
    if (!set) return fail(set.error());
    const VkCommandBuffer commands = frame.commands();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, (*pipeline)->handle.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, (*pipeline)->layout.get(), 0, 1, &*set,
                            0, nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    return {};
}

// A whole image, from nothing but what the set holds.
Status Renderer::Passes::fill(const gpu::Pipeline& pipeline, VkDescriptorSet set, const gpu::Image& target) {
    const VkCommandBuffer commands = frame.commands();
    gpu::image_barrier_discarding(commands, target.get(), Use::sampled, Use::color_target);
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = target.view();
    color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = target.info().extent;
    rendering.layerCount = 1;
    rendering.viewMask = views > 1 ? (1U << views) - 1U : 0U;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, target.info().extent);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.layout.get(), 0, 1, &set, 0,
                            nullptr);
    vkCmdDraw(commands, 3, 1, 0, 0);
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, target.get(), Use::color_target, Use::sampled);
    return {};
}

Status Renderer::Passes::occlusion(Targets& target, const DrawList& list, const gpu::Piece& instances) {
    if (Status made = renderer.make_occlusion_targets(target); !made) return made;
    const auto pipelines = renderer.occlusion_pipelines(views);
    if (!pipelines) return fail(pipelines.error());
    const auto& [depth_pipeline, slices, smooth] = **pipelines;
    gpu::Device& device = *renderer.device_;
    const auto set_of = [&](const gpu::Pipeline& pipeline, const auto& bind) -> Result<VkDescriptorSet> {
        Result<gpu::SetWriter> writer = gpu::SetWriter::create(device, frame, pipeline, 0);
        if (!writer) return fail(writer.error());
        return bind(*writer).finish();
    };
    const VkSampler nearest = renderer.nearest_.get();
    constexpr VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL;
    const auto depth_set = set_of(
        depth_pipeline, [&](gpu::SetWriter & w) -> auto& {
            return w.piece(0, frame_block).piece(1, instances);
        });
    if (!depth_set) return fail(depth_set.error());
    const auto slices_set = set_of(
        slices, [&](gpu::SetWriter & w) -> auto& {
            return w.piece(0, frame_block).image(3, target.small_depth.view(), nearest, depth_layout);
        });
    if (!slices_set) return fail(slices_set.error());
    const auto smooth_set = set_of(
        smooth, [&](gpu::SetWriter & w) -> auto& {
            return w.image(3, target.small_depth.view(), nearest, depth_layout)
                .image(4, target.raw_occlusion.view(), nearest);
        });
    if (!smooth_set) return fail(smooth_set.error());

    const VkCommandBuffer commands = frame.commands();
    gpu::image_barrier_discarding(commands, target.small_depth.get(), Use::depth_read, Use::depth_target,
                                  depth_range);
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = target.small_depth.view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = target.small_depth.info().extent;
    rendering.layerCount = 1;
    rendering.viewMask = views > 1 ? (1U << views) - 1U : 0U;
    rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, target.small_depth.info().extent);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, depth_pipeline.handle.get());
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, depth_pipeline.layout.get(), 0, 1,
                            &*depth_set, 0, nullptr);
    const GpuModel* bound = nullptr;
    for (const Draw& d : list.draws) {
        if (d.kind.blends) continue;
        if (std::exchange(bound, d.model) != d.model) bind_geometry(commands, *d.model);
        draw(commands, d);
    }
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, target.small_depth.get(), Use::depth_target, Use::depth_read, depth_range);
    if (Status done = fill(slices, *slices_set, target.raw_occlusion); !done) return done;
    if (Status done = fill(smooth, *smooth_set, target.occlusion); !done) return done;
    occlusion_view = target.occlusion.view();
    return {};
}

Status Renderer::Passes::draw_into(const Targets& target, const DrawList& list, const gpu::Piece& instances,
                                   const gpu::Piece& materials) {
    const VkCommandBuffer commands = frame.commands();
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = target.drawn.view();
    color.imageLayout = color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = target.picture.view();
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    // A plain background is what the picture is cleared to: no pixel of it is shaded.
    const bool plain = scene.background.w > 0.5F;
    const glm::vec3 behind = pbr_neutral(glm::vec3(scene.background) * scene.exposure);
    if (plain) color.clearValue.color = {{behind.r, behind.g, behind.b, 1.0F}};
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = target.depth.view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = renderer.extent_;
    rendering.layerCount = 1;
    rendering.viewMask = views > 1 ? (1U << views) - 1U : 0U;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, renderer.extent_);
    // What blends needs the sky behind it, and the sky costs least where something stands in front.
    DrawList opaque = list, blending = list;
    std::erase_if(opaque.draws, [](const Draw& d) { return d.kind.blends; });
    std::erase_if(blending.draws, [](const Draw& d) { return !d.kind.blends; });
    Status drawn = draw_scene(opaque, instances, materials);
    if (drawn && !plain) drawn = draw_sky();
    if (drawn) drawn = draw_scene(blending, instances, materials);
    vkCmdEndRendering(commands);
    return drawn;
}

Status Renderer::Passes::picture(const DrawList& list) {
    Result<gpu::Piece> instances = put<shared::Instance>(frame, list.instances);
    if (!instances) return fail(instances.error());
    Result<gpu::Piece> materials = put<shared::Material>(frame, list.materials);
    if (!materials) return fail(materials.error());

    const VkCommandBuffer commands = frame.commands();
    frame.begin_timing("scene");
    const shared::Frame all = shared;
    for (std::size_t pass = 0; pass < renderer.targets_.size(); ++pass) {
        Targets& target = renderer.targets_[pass];
        if (pass > 0) {
            shared.views[0] = all.views[pass];
            if (Status put = put_frame(); !put) return put;
        }
        occlusion_view = renderer.white_array_.get();
        if (shared.occlusion.x > 0.0F)
            if (Status done = occlusion(target, list, *instances); !done) return done;
        gpu::image_barrier_discarding(commands, target.drawn.get(), Use::color_target, Use::color_target);
        gpu::image_barrier_discarding(commands, target.depth.get(), Use::depth_target, Use::depth_target,
                                      depth_range);
        gpu::image_barrier_discarding(commands, target.picture.get(), Use::transfer_from, Use::color_target);
        if (Status drawn = draw_into(target, list, *instances, *materials); !drawn) return drawn;
        gpu::image_barrier(commands, target.picture.get(), Use::color_target, Use::transfer_from);
    }
    frame.end_timing();
    return {};
}

}  // namespace bolt::render
