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
    constants.skinned = !deformable.joints.empty() && !deformation.joints.empty() ? 1 : 0;
    constants.first_delta = deformable.first_delta;
    constants.delta_floats = deformable.delta_floats;
    constants.targets =
        static_cast<std::uint32_t>(std::min(deformable.targets.size(), deformation.weights.size()));
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
            if (job.constants.skinned != 0 && part.deformable.joints.size() > deformation->joints.size())
                return fail(ErrorCode::failed,
                            fmt::format("a deformation has {} joints, but a part uses joint {}",
                                        deformation->joints.size(), part.deformable.joints.size() - 1));
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

Result<VkDescriptorSet> DeformPass::set_for(PassContext& context, const Object& object) {
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
            BOLT_TRY_ASSIGN(auto set, set_for(context, *job.object));
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

Result<const gpu::Pipeline*> SurfacePass::pipeline(gpu::Device& device, const PipelineKind& kind,
                                                   std::uint32_t views, bool per_pixel_material) {
    // Features that only lighting uses do not need a pipeline of their own.
    PipelineKey key{kind, views, per_pixel_material};
    key.kind.features &= SCENE_ANY_MAP | SCENE_SECOND_UV | SCENE_VERTEX_COLORS | SCENE_TANGENTS |
                         SCENE_ANISOTROPY | SCENE_MASK | SCENE_TINTED | SCENE_PER_PIXEL_MATERIAL | SCENE_CUT;
    const auto known = pipelines_.find(key);
    if (known != pipelines_.end()) return &known->second;
    gpu::GraphicsInfo info = part_pipeline(*shaders_, key.kind, views);
    info.fragment = &shaders_->at(per_pixel_material ? "surface_material.frag" : "surface.frag");
    info.colors = {surface_format};
    if (per_pixel_material)
        info.colors.insert(info.colors.end(), {material_color_format, material_roughness_format});
    BOLT_TRY_ASSIGN(auto pipeline, gpu::make_graphics_pipeline(device, *cache_, info));
    return &pipelines_.emplace(key, std::move(pipeline)).first->second;
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
        // Pixels without a covered sample are never read.
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
    const Status drawn = draw_parts(context, list, drawing);
    vkCmdEndRendering(commands);
    for (const gpu::Image* image : buffers)
        gpu::image_barrier(commands, image->get(), ResourceUse::color_target, ResourceUse::sampled);
    gpu::image_barrier(commands, targets.depth.get(), ResourceUse::depth_target, ResourceUse::depth_read,
                       depth_range);
    if (keeps_depth)
        gpu::image_barrier(commands, targets.kept_depth.get(), ResourceUse::depth_target,
                           ResourceUse::transfer_from, depth_range);
    context.frame.end_timing();
    return drawn;
}

}  // namespace bolt::render
