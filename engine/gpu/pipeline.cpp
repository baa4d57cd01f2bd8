#include "engine/gpu/pipeline.hpp"

#include <fmt/format.h>
#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <optional>

#include "engine/base/file.hpp"

namespace bolt::gpu {

namespace {

using SpirvCrossContext = std::unique_ptr<spvc_context_s, decltype(&spvc_context_destroy)>;

std::optional<VkShaderStageFlagBits> stage_of(SpvExecutionModel model) {
    switch (model) {
        case SpvExecutionModelVertex:
            return VK_SHADER_STAGE_VERTEX_BIT;
        case SpvExecutionModelFragment:
            return VK_SHADER_STAGE_FRAGMENT_BIT;
        case SpvExecutionModelGLCompute:
            return VK_SHADER_STAGE_COMPUTE_BIT;
        default:
            return std::nullopt;
    }
}

VkFormat format_of(spvc_basetype base, unsigned width) {
    constexpr VkFormat floats[] = {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
                                   VK_FORMAT_R32G32B32A32_SFLOAT};
    constexpr VkFormat unsigneds[] = {VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32B32_UINT,
                                      VK_FORMAT_R32G32B32A32_UINT};
    if (width < 1 || width > 4) return VK_FORMAT_UNDEFINED;
    if (base == SPVC_BASETYPE_FP32) return floats[width - 1];
    if (base == SPVC_BASETYPE_UINT32) return unsigneds[width - 1];
    return VK_FORMAT_UNDEFINED;
}

// Returns the resources of one type.
std::span<const spvc_reflected_resource> list(spvc_resources resources, spvc_resource_type type) {
    const spvc_reflected_resource* first = nullptr;
    std::size_t count = 0;
    if (spvc_resources_get_resource_list_for_type(resources, type, &first, &count) != SPVC_SUCCESS) return {};
    return {first, count};
}

std::uint32_t array_size(spvc_compiler compiler, spvc_type_id id) {
    const spvc_type type = spvc_compiler_get_type_handle(compiler, id);
    return spvc_type_get_num_array_dimensions(type) == 0 ? 1 : spvc_type_get_array_dimension(type, 0);
}

}  // namespace

Result<Reflection> reflect(std::span<const std::uint32_t> spirv) {
    spvc_context raw = nullptr;
    if (spvc_context_create(&raw) != SPVC_SUCCESS)
        return fail(ErrorCode::failed, "not enough memory to reflect a shader", "free memory");
    const SpirvCrossContext context(raw, spvc_context_destroy);
    spvc_parsed_ir parsed = nullptr;
    spvc_compiler compiler = nullptr;
    spvc_resources resources = nullptr;
    spvc_set active = nullptr;  // the resources that the shader uses; its includes may declare more
    const bool read =
        spvc_context_parse_spirv(raw, spirv.data(), spirv.size(), &parsed) == SPVC_SUCCESS &&
        spvc_context_create_compiler(raw, SPVC_BACKEND_NONE, parsed, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP,
                                     &compiler) == SPVC_SUCCESS &&
        spvc_compiler_get_active_interface_variables(compiler, &active) == SPVC_SUCCESS &&
        spvc_compiler_create_shader_resources_for_active_variables(compiler, &resources, active) ==
            SPVC_SUCCESS;
    if (!read)
        return fail(ErrorCode::failed,
                    fmt::format("not a SPIR-V shader: {}", spvc_context_get_last_error_string(raw)),
                    "output of glslangValidator");

    Reflection reflection;
    const std::optional<VkShaderStageFlagBits> stage = stage_of(spvc_compiler_get_execution_model(compiler));
    if (!stage)
        return fail(ErrorCode::failed, "the shader stage is not supported", "vertex, fragment or compute");
    reflection.stage = *stage;

    constexpr std::pair<spvc_resource_type, VkDescriptorType> kinds[] = {
        {SPVC_RESOURCE_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
        {SPVC_RESOURCE_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
        {SPVC_RESOURCE_TYPE_SAMPLED_IMAGE, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
        {SPVC_RESOURCE_TYPE_SEPARATE_IMAGE, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
        {SPVC_RESOURCE_TYPE_SEPARATE_SAMPLERS, VK_DESCRIPTOR_TYPE_SAMPLER},
        {SPVC_RESOURCE_TYPE_STORAGE_IMAGE, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    for (const auto& [kind, type] : kinds) {
        for (const spvc_reflected_resource& resource : list(resources, kind)) {
            Binding binding;
            binding.set = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationDescriptorSet);
            binding.binding = spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationBinding);
            binding.count = array_size(compiler, resource.type_id);
            binding.type = type;
            binding.name = resource.name;
            reflection.bindings.push_back(std::move(binding));
        }
    }
    std::sort(reflection.bindings.begin(), reflection.bindings.end(), [](const Binding& a, const Binding& b) {
        return std::pair{a.set, a.binding} < std::pair{b.set, b.binding};
    });
    for (const spvc_reflected_resource& resource : list(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT)) {
        std::size_t size = 0;
        spvc_compiler_get_declared_struct_size(
            compiler, spvc_compiler_get_type_handle(compiler, resource.base_type_id), &size);
        reflection.push_constants = static_cast<std::uint32_t>(size);
    }
    if (reflection.stage == VK_SHADER_STAGE_VERTEX_BIT) {
        for (const spvc_reflected_resource& resource : list(resources, SPVC_RESOURCE_TYPE_STAGE_INPUT)) {
            const spvc_type type = spvc_compiler_get_type_handle(compiler, resource.base_type_id);
            const VkFormat format = format_of(spvc_type_get_basetype(type), spvc_type_get_vector_size(type));
            if (format == VK_FORMAT_UNDEFINED)
                return fail(ErrorCode::failed,
                            fmt::format("the vertex input \"{}\" has an unsupported type", resource.name),
                            "one to four floats or uints");
            reflection.inputs.push_back(
                {spvc_compiler_get_decoration(compiler, resource.id, SpvDecorationLocation), format,
                 resource.name});
        }
        std::sort(reflection.inputs.begin(), reflection.inputs.end(),
                  [](const VertexInput& a, const VertexInput& b) { return a.location < b.location; });
    }
    return reflection;
}

namespace {

constexpr std::size_t max_cache_size = std::size_t{256} << 20;  // bytes

Result<ShaderModule> make_module(const Device& device, const Shader& shader) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = shader.spirv.size() * sizeof(std::uint32_t);
    info.pCode = shader.spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    BOLT_TRY(check(vkCreateShaderModule(device.get(), &info, nullptr, &module), shader.name));
    return ShaderModule(device.get(), module);
}

// Checks that every vertex input of the shader has a stream. Unused streams are allowed.
Status check_streams(const GraphicsInfo& info) {
    for (const VertexInput& input : info.vertex->reflection.inputs) {
        const bool has_stream =
            std::any_of(info.streams.begin(), info.streams.end(),
                        [&](const VertexStream& stream) { return stream.location == input.location; });
        if (!has_stream)
            return fail(ErrorCode::failed,
                        fmt::format("{}: no vertex stream for the input \"{}\" at location {}",
                                    info.vertex->name, input.name, input.location),
                        "a stream for each input");
    }
    return {};
}

struct VertexLayout {
    std::vector<VkVertexInputBindingDescription> buffers;
    std::vector<VkVertexInputAttributeDescription> attributes;

    explicit VertexLayout(const GraphicsInfo& info) {
        for (std::uint32_t i = 0; i < info.strides.size(); ++i)
            buffers.push_back({i, info.strides[i], VK_VERTEX_INPUT_RATE_VERTEX});
        for (const VertexStream& stream : info.streams) {
            const auto& inputs = info.vertex->reflection.inputs;
            const bool read = std::any_of(inputs.begin(), inputs.end(), [&](const VertexInput& input) {
                return input.location == stream.location;
            });
            if (read) attributes.push_back({stream.location, stream.buffer, stream.format, stream.offset});
        }
    }
};

}  // namespace

Result<Shader> make_shader(std::string name, std::span<const std::uint32_t> spirv) {
    Result<Reflection> reflection = reflect(spirv);
    if (!reflection) {
        Error error = reflection.error();
        error.what = fmt::format("{}: {}", name, error.what);
        return fail(std::move(error));
    }
    return Shader{std::move(name), {spirv.begin(), spirv.end()}, std::move(*reflection)};
}

Result<PipelineCache> PipelineCache::open(const Device& device, std::filesystem::path file) {
    PipelineCache cache;
    cache.device_ = &device;
    cache.file_ = std::move(file);
    std::string stored;
    if (!cache.file_.empty())
        if (Result<std::string> text = read_file(cache.file_, max_cache_size, ErrorCode::failed))
            stored = std::move(*text);
    // The specification requires drivers to reject the cache of another driver, but some did not. So the
    // header is compared first.
    VkPipelineCacheHeaderVersionOne header{};
    if (stored.size() >= sizeof header) std::memcpy(&header, stored.data(), sizeof header);
    const VkPhysicalDeviceProperties& ours = device.properties();
    cache.restored_ = stored.size() >= sizeof header &&
                      header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
                      header.vendorID == ours.vendorID && header.deviceID == ours.deviceID &&
                      std::memcmp(header.pipelineCacheUUID, ours.pipelineCacheUUID, VK_UUID_SIZE) == 0;
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    cache.stored_size_ = stored.size();
    info.initialDataSize = cache.restored_ ? stored.size() : 0;
    info.pInitialData = stored.data();
    VkPipelineCache created = VK_NULL_HANDLE;
    BOLT_TRY(
        check(vkCreatePipelineCache(device.get(), &info, nullptr, &created), "creating a pipeline cache"));
    cache.cache_ = PipelineCacheHandle(device.get(), created);
    return cache;
}

Status PipelineCache::save() const {
    if (file_.empty()) return {};
    std::size_t size = 0;
    const VkResult counted = vkGetPipelineCacheData(device_->get(), cache_.get(), &size, nullptr);
    BOLT_TRY(check(counted, "reading the pipeline cache"));
    std::string data(size, '\0');
    const VkResult got = vkGetPipelineCacheData(device_->get(), cache_.get(), &size, data.data());
    BOLT_TRY(check(got, "reading the pipeline cache"));
    data.resize(size);
    if (restored_ && size == stored_size_) return {};
    std::error_code ignored;  // write_file reports a missing folder
    std::filesystem::create_directories(file_.parent_path(), ignored);
    return write_file(file_, data);
}

Status make_pipeline_layout(const Device& device, std::span<const Shader* const> shaders,
                            Pipeline& pipeline) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<Binding, VkShaderStageFlags>> merged;
    std::uint32_t sets = 0;
    for (const Shader* shader : shaders) {
        const Reflection& reflection = shader->reflection;
        for (const Binding& binding : reflection.bindings) {
            const auto [entry, inserted] =
                merged.try_emplace({binding.set, binding.binding}, binding, VkShaderStageFlags{0});
            const Binding& known = entry->second.first;
            if (!inserted && (known.type != binding.type || known.count != binding.count))
                return fail(
                    ErrorCode::failed,
                    fmt::format("{}: set {} binding {} (\"{}\") has another type or count in another stage",
                                shader->name, binding.set, binding.binding, binding.name),
                    "the same declaration in all stages");
            entry->second.second |= static_cast<VkShaderStageFlags>(reflection.stage);
            sets = std::max(sets, binding.set + 1);
        }
        if (reflection.push_constants > 0) {
            pipeline.push_stages |= static_cast<VkShaderStageFlags>(reflection.stage);
            pipeline.push_size = std::max(pipeline.push_size, reflection.push_constants);
        }
    }
    if (pipeline.push_size > device.limits().maxPushConstantsSize)
        return fail(ErrorCode::failed,
                    fmt::format("{} bytes of push constants exceed the limit of the GPU ({})",
                                pipeline.push_size, device.limits().maxPushConstantsSize),
                    "a uniform buffer for the rest");

    std::vector<std::vector<VkDescriptorSetLayoutBinding>> bindings(sets);
    for (const auto& [key, value] : merged) {
        const Binding& binding = value.first;
        bindings[binding.set].push_back(
            {binding.binding, binding.type, binding.count, value.second, nullptr});
        pipeline.bindings.push_back(binding);
    }
    std::vector<VkDescriptorSetLayout> layouts;
    for (const std::vector<VkDescriptorSetLayoutBinding>& set : bindings) {
        VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
        info.bindingCount = static_cast<std::uint32_t>(set.size());
        info.pBindings = set.data();
        VkDescriptorSetLayout layout = VK_NULL_HANDLE;
        const VkResult created = vkCreateDescriptorSetLayout(device.get(), &info, nullptr, &layout);
        BOLT_TRY(check(created, "creating a descriptor set layout"));
        pipeline.sets.emplace_back(device.get(), layout);
        layouts.push_back(layout);
    }
    const VkPushConstantRange range{pipeline.push_stages, 0, pipeline.push_size};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = static_cast<std::uint32_t>(layouts.size());
    info.pSetLayouts = layouts.data();
    info.pushConstantRangeCount = pipeline.push_size > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    BOLT_TRY(
        check(vkCreatePipelineLayout(device.get(), &info, nullptr, &layout), "creating a pipeline layout"));
    pipeline.layout = PipelineLayout(device.get(), layout);
    return {};
}

Result<Pipeline> make_graphics_pipeline(const Device& device, const PipelineCache& cache,
                                        const GraphicsInfo& info) {
    BOLT_TRY(check_streams(info));
    Pipeline pipeline;
    std::vector<const Shader*> shaders{info.vertex};
    if (info.fragment != nullptr) shaders.push_back(info.fragment);
    BOLT_TRY(make_pipeline_layout(device, shaders, pipeline));

    const VkSpecializationMapEntry entry{0, 0, sizeof info.constants};
    const VkSpecializationInfo constants{1, &entry, sizeof info.constants, &info.constants};
    std::vector<ShaderModule> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const Shader* shader : shaders) {
        BOLT_TRY_ASSIGN(auto module, make_module(device, *shader));
        VkPipelineShaderStageCreateInfo stage{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        stage.stage = shader->reflection.stage;
        stage.module = module.get();
        stage.pName = "main";
        stage.pSpecializationInfo = info.constants != 0 ? &constants : nullptr;
        stages.push_back(stage);
        modules.push_back(std::move(module));
    }
    const VertexLayout vertices(info);
    VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    input.vertexBindingDescriptionCount = static_cast<std::uint32_t>(vertices.buffers.size());
    input.pVertexBindingDescriptions = vertices.buffers.data();
    input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(vertices.attributes.size());
    input.pVertexAttributeDescriptions = vertices.attributes.data();
    VkPipelineInputAssemblyStateCreateInfo assembly{
        VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = info.topology;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.polygonMode = VK_POLYGON_MODE_FILL;
    raster.cullMode = info.cull;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1.0F;
    raster.depthClampEnable = info.depth_clamp ? VK_TRUE : VK_FALSE;
    raster.depthBiasEnable = info.depth_bias != 0.0F || info.depth_bias_slope != 0.0F ? VK_TRUE : VK_FALSE;
    raster.depthBiasConstantFactor = info.depth_bias;
    raster.depthBiasSlopeFactor = info.depth_bias_slope;
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = info.samples;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = info.depth_test ? VK_TRUE : VK_FALSE;
    depth.depthWriteEnable = info.depth_write ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = info.depth_compare;
    VkPipelineColorBlendAttachmentState blend{};
    blend.blendEnable = info.blend ? VK_TRUE : VK_FALSE;
    blend.srcColorBlendFactor = blend.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    blend.dstColorBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    std::vector<VkPipelineColorBlendAttachmentState> blends(info.colors.size(), blend);
    for (std::size_t i = 0; i < blends.size(); ++i)
        if ((info.written_colors >> i & 1U) != 0)
            blends[i].colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                       VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    VkPipelineColorBlendStateCreateInfo blending{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blending.attachmentCount = static_cast<std::uint32_t>(blends.size());
    blending.pAttachments = blends.data();
    constexpr VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = static_cast<std::uint32_t>(std::size(dynamic_states));
    dynamic.pDynamicStates = dynamic_states;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.viewMask = info.view_mask;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(info.colors.size());
    rendering.pColorAttachmentFormats = info.colors.data();
    rendering.depthAttachmentFormat = info.depth;

    VkGraphicsPipelineCreateInfo create{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    create.pNext = &rendering;
    create.stageCount = static_cast<std::uint32_t>(stages.size());
    create.pStages = stages.data();
    create.pVertexInputState = &input;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &samples;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &blending;
    create.pDynamicState = &dynamic;
    create.layout = pipeline.layout.get();
    VkPipeline handle = VK_NULL_HANDLE;
    const VkResult created =
        vkCreateGraphicsPipelines(device.get(), cache.get(), 1, &create, nullptr, &handle);
    BOLT_TRY(check(created, fmt::format("creating the pipeline of {}", info.vertex->name)));
    pipeline.handle = PipelineHandle(device.get(), handle);
    return pipeline;
}

Result<Pipeline> make_compute_pipeline(const Device& device, const PipelineCache& cache, const Shader& shader,
                                       std::uint32_t constants) {
    Pipeline pipeline;
    const Shader* shaders[] = {&shader};
    BOLT_TRY(make_pipeline_layout(device, shaders, pipeline));
    BOLT_TRY_ASSIGN(auto module, make_module(device, shader));
    VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    create.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                    nullptr,
                    0,
                    VK_SHADER_STAGE_COMPUTE_BIT,
                    module.get(),
                    "main",
                    nullptr};
    const VkSpecializationMapEntry entry{0, 0, sizeof constants};
    const VkSpecializationInfo specialization{1, &entry, sizeof constants, &constants};
    if (constants != 0) create.stage.pSpecializationInfo = &specialization;
    create.layout = pipeline.layout.get();
    VkPipeline handle = VK_NULL_HANDLE;
    const VkResult created =
        vkCreateComputePipelines(device.get(), cache.get(), 1, &create, nullptr, &handle);
    BOLT_TRY(check(created, fmt::format("creating the pipeline of {}", shader.name)));
    pipeline.handle = PipelineHandle(device.get(), handle);
    return pipeline;
}

}  // namespace bolt::gpu
