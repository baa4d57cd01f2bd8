#include "engine/render/passes/geometry.hpp"

#include <fmt/format.h>

#include <set>

namespace bolt::render {

using gpu::ResourceUse;

namespace {

constexpr std::uint32_t group_size = 64;  // see deform.comp
constexpr std::uint32_t position_words = sizeof(glm::vec3) / 4;
constexpr std::uint32_t attribute_words = sizeof(VertexAttributes) / 4;
static_assert(attribute_words == 7, "deform.comp has the same constant");

shared::DeformPart push_constants_of(const MeshPart& part, const Deformation& deformation) {
    const Deformable& deformable = part.deformable;
    shared::DeformPart constants{};
    constants.vertices = deformable.vertices;
    constants.first_vertex = static_cast<std::uint32_t>(part.first_vertex);
    constants.first_influence = deformable.first_influence;
    constants.skinned = !deformable.joint_boxes.empty() && !deformation.joints.empty() ? 1 : 0;
    constants.first_delta = deformable.first_delta;
    constants.delta_floats = deformable.delta_floats;
    constants.targets =
        static_cast<std::uint32_t>(std::min(deformable.target_boxes.size(), deformation.weights.size()));
    constants.own_normals = deformable.own_normals ? 1 : 0;
    return constants;
}

}  // namespace

Result<DeformPass> DeformPass::create(const PassSetup& setup) {
    DeformPass pass;
    BOLT_TRY(assign(pass.pipeline_,
                    gpu::make_compute_pipeline(setup.device, setup.cache, setup.shaders.at("deform.comp"))));
    return pass;
}

// Lists the jobs, assigns their output ranges and grows the buffer.
Status DeformPass::plan(PassContext& context, std::vector<Job>& jobs) {
    std::uint32_t words = 0;
    std::set<std::pair<const Deformation*, const MeshPart*>> planned;
    for (const Object& object : context.scene.objects) {
        const Deformation* deformation = object.deformation.get();
        if (deformation == nullptr) continue;
        const MeshRange range = object.model->meshes[object.mesh];
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            const MeshPart& part = object.model->parts[i];
            if (part.deformable.vertices == 0 || !planned.insert({deformation, &part}).second) continue;
            Job job{&object, &part, push_constants_of(part, *deformation)};
            if (job.constants.skinned != 0 && part.deformable.joint_boxes.size() > deformation->joints.size())
                return fail(ErrorCode::failed,
                            fmt::format("a deformation has {} joints, but a part uses joint {}",
                                        deformation->joints.size(), part.deformable.joint_boxes.size() - 1),
                            "a joint for each index");
            job.constants.positions = words;
            job.constants.attributes = words + position_words * part.deformable.vertices;
            words = job.constants.attributes + attribute_words * part.deformable.vertices;
            jobs.push_back(job);
        }
    }
    const VkDeviceSize bytes = VkDeviceSize{4} * words;
    if (bytes > vertices_.size()) {
        BOLT_TRY_ASSIGN(
            auto larger,
            gpu::Buffer::create(context.device, std::max(bytes, 2 * vertices_.size()),
                                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT |
                                    VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                gpu::MemoryUse::device));
        context.frame.retire(std::exchange(vertices_, std::move(larger)));
    }
    for (const Job& job : jobs)
        parts_.insert_or_assign({job.object->deformation.get(), job.part},
                                DeformedPart{vertices_.get(), VkDeviceSize{4} * job.constants.positions,
                                             VkDeviceSize{4} * job.constants.attributes});
    return {};
}

Result<VkDescriptorSet> DeformPass::descriptor_set_for(PassContext& context, const Object& object) {
    BOLT_TRY_ASSIGN(auto joints, upload_transient<glm::mat4>(context.frame, object.deformation->joints));
    BOLT_TRY_ASSIGN(auto weights, upload_transient<float>(context.frame, object.deformation->weights));
    BOLT_TRY_ASSIGN(auto writer, gpu::DescriptorWriter::create(context.device, context.frame, pipeline_, 0));
    const GpuModel& model = *object.model;
    // The shader does not read buffers that a model lacks, but every binding needs a buffer.
    const auto bind_whole = [&](std::uint32_t binding, const gpu::Buffer& buffer) {
        const gpu::Buffer& bound = buffer.get() != VK_NULL_HANDLE ? buffer : model.positions;
        writer.buffer(binding, bound.get(), 0, bound.size());
    };
    bind_whole(0, model.positions);
    bind_whole(1, model.attributes);
    bind_whole(2, model.influences);
    bind_whole(3, model.deltas);
    bind_whole(6, vertices_);
    return writer.range(4, joints).range(5, weights).finish();
}

Status DeformPass::draw(PassContext& context) {
    parts_.clear();
    std::vector<Job> jobs;
    BOLT_TRY(plan(context, jobs));
    if (jobs.empty()) return {};
    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("deform");
    gpu::memory_barrier(commands, ResourceUse::vertex_read, ResourceUse::storage_write);  // previous frame
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.handle.get());
    const Object* object = nullptr;
    for (const Job& job : jobs) {
        if (std::exchange(object, job.object) != job.object) {
            BOLT_TRY_ASSIGN(auto set, descriptor_set_for(context, *job.object));
            vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.layout.get(), 0, 1,
                                    &set, 0, nullptr);
        }
        vkCmdPushConstants(commands, pipeline_.layout.get(), pipeline_.push_stages, 0, sizeof job.constants,
                           &job.constants);
        vkCmdDispatch(commands, (job.constants.vertices + group_size - 1) / group_size, 1, 1);
    }
    gpu::memory_barrier(commands, ResourceUse::storage_write, ResourceUse::vertex_read);
    context.frame.end_timing();
    return {};
}

namespace {

std::vector<VkFormat> color_formats(bool per_pixel_material) {
    if (!per_pixel_material) return {surface_format};
    return {surface_format, material_color_format, material_roughness_format};
}

}  // namespace

Result<const gpu::Pipeline*> SurfacePass::pipeline(gpu::Device& device, const PipelineKind& kind,
                                                   std::uint32_t views, bool per_pixel_material) {
    // Features that only lighting uses do not need a pipeline of their own.
    PipelineKey key{kind, views, per_pixel_material};
    key.kind.features &= SCENE_ANY_MAP | SCENE_SECOND_UV | SCENE_VERTEX_COLORS | SCENE_TANGENTS |
                         SCENE_ANISOTROPY | SCENE_MASK | SCENE_TINTED | SCENE_PER_PIXEL_MATERIAL | SCENE_CUT;
    const auto known = pipelines_.find(key);
    if (known != pipelines_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, key.kind, views);
    // Parts whose values are the material's constants do not write the material buffer, which saves GPU time.
    const bool writes_material = (kind.features & SCENE_PER_PIXEL_MATERIAL) != 0;
    info.fragment = &shaders_->at(writes_material ? "surface_material.frag" : "surface.frag");
    info.colors = color_formats(per_pixel_material);
    if (!writes_material) info.written_colors = 1;
    BOLT_TRY_ASSIGN(auto pipeline, gpu::make_graphics_pipeline(device, *cache_, info));
    return &pipelines_.emplace(key, std::move(pipeline)).first->second;
}

Status SurfacePass::draw_hidden_area(PassContext& context, VkSampleCountFlagBits samples_per_pixel,
                                     const std::vector<VkFormat>& colors) {
    std::vector<glm::vec3> corners;  // z: the view
    for (std::size_t view = 0; view < context.eyes.size(); ++view)
        if (const auto& hidden = context.eyes[view].hidden)
            for (const glm::vec2& corner : *hidden) corners.emplace_back(corner, static_cast<float>(view));
    BOLT_TRY_ASSIGN(const auto vertices,
                    upload_transient<glm::vec3>(context.frame, std::span<const glm::vec3>(corners)));
    gpu::Pipeline& pipeline = hidden_areas_[{context.views, samples_per_pixel, colors.size()}];
    if (!pipeline.handle) {
        gpu::GraphicsInfo info;
        info.vertex = &shaders_->at("hidden.vert");
        info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
        info.strides = {sizeof(glm::vec3)};
        info.colors = colors;
        info.written_colors = 0;
        info.depth = depth_format;
        info.depth_compare = VK_COMPARE_OP_ALWAYS;
        info.samples = samples_per_pixel;
        info.cull = VK_CULL_MODE_NONE;
        set_views(info, context.views);
        BOLT_TRY(assign(pipeline, gpu::make_graphics_pipeline(context.device, *cache_, info)));
    }
    const VkCommandBuffer commands = context.frame.commands();
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle.get());
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices.buffer, &vertices.offset);
    vkCmdDraw(commands, static_cast<std::uint32_t>(corners.size()), 1, 0, 0);
    return {};
}

Status SurfacePass::clear_hidden_depth(PassContext& context, const RenderTargets& targets) {
    const VkCommandBuffer commands = context.frame.commands();
    gpu::image_barrier(commands, targets.kept_depth.get(), ResourceUse::depth_target,
                       ResourceUse::depth_target, depth_range);
    const VkRenderingAttachmentInfo depth =
        attachment(targets.kept_depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_STORE_OP_STORE);
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, {}, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    // The viewport's depth range makes every depth 0.
    const VkViewport far{
        0.0F, 0.0F, static_cast<float>(context.extent.width), static_cast<float>(context.extent.height),
        0.0F, 0.0F};
    vkCmdSetViewport(commands, 0, 1, &far);
    const Status drawn = draw_hidden_area(context, VK_SAMPLE_COUNT_1_BIT, {});
    vkCmdEndRendering(commands);
    return drawn;
}

Status SurfacePass::draw(PassContext& context, RenderTargets& targets, const DrawList& list) {
    const bool per_pixel_material = (list.features & SCENE_PER_PIXEL_MATERIAL) != 0;
    if (per_pixel_material) BOLT_TRY(add_material_targets(context.device, targets));
    std::vector<const gpu::Image*> buffers{&targets.surfaces};
    if (per_pixel_material)
        buffers.insert(buffers.end(), {&targets.material_colors, &targets.material_roughness});

    const VkCommandBuffer commands = context.frame.commands();
    context.frame.begin_timing("surfaces");
    std::vector<VkRenderingAttachmentInfo> colors;
    for (const gpu::Image* image : buffers) {
        gpu::image_barrier_discarding(commands, image->get(), ResourceUse::sampled,
                                      ResourceUse::color_target);
        // The values of samples without geometry are never used.
        colors.push_back(attachment(image->view(), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                    VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE));
    }
    gpu::image_barrier_discarding(commands, targets.depth.get(), ResourceUse::depth_read,
                                  ResourceUse::depth_target, depth_range);
    VkRenderingAttachmentInfo depth =
        attachment(targets.depth.view(), VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL,
                   VK_ATTACHMENT_LOAD_OP_CLEAR, VK_ATTACHMENT_STORE_OP_STORE);
    const bool keeps_depth = targets.kept_depth.get() != VK_NULL_HANDLE;
    if (keeps_depth) {
        gpu::image_barrier_discarding(commands, targets.kept_depth.get(), ResourceUse::transfer_from,
                                      ResourceUse::depth_target, depth_range);
        depth.resolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
        depth.resolveImageView = targets.kept_depth.view();
        depth.resolveImageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    }
    const VkRenderingInfo rendering = rendering_info(context.extent, context.views, colors, &depth);
    vkCmdBeginRendering(commands, &rendering);
    set_area(commands, context.extent);
    PartDrawing drawing;
    drawing.wanted = [](const PipelineKind& kind) { return !kind.forward; };
    drawing.pipeline = [&](const PipelineKind& kind) {
        return pipeline(context.device, kind, context.views, per_pixel_material);
    };
    drawing.frame_set = [&](const gpu::Pipeline& pipeline) -> Result<VkDescriptorSet> {
        BOLT_TRY_ASSIGN(auto writer,
                        gpu::DescriptorWriter::create(context.device, context.frame, pipeline, 0));
        return writer.range(0, context.frame_block)
            .range(1, context.instances)
            .range(2, context.materials)
            .finish();
    };
    Status drawn;
    if (has_hidden_area(context.eyes))
        drawn = draw_hidden_area(context, samples, color_formats(per_pixel_material));
    if (drawn) drawn = draw_parts(context, list, drawing);
    vkCmdEndRendering(commands);
    for (const gpu::Image* image : buffers)
        gpu::image_barrier(commands, image->get(), ResourceUse::color_target, ResourceUse::sampled);
    gpu::image_barrier(commands, targets.depth.get(), ResourceUse::depth_target, ResourceUse::depth_read,
                       depth_range);
    if (drawn && keeps_depth && has_hidden_area(context.eyes)) drawn = clear_hidden_depth(context, targets);
    if (keeps_depth)
        gpu::image_barrier(commands, targets.kept_depth.get(), ResourceUse::depth_target,
                           ResourceUse::transfer_from, depth_range);
    context.frame.end_timing();
    return drawn;
}

}  // namespace bolt::render
