#include "engine/gpu/pipeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "engine/base/file.hpp"
#include "engine/gpu/layout.hpp"

namespace bolt::gpu {

namespace {

constexpr std::size_t largest_cache = std::size_t{256} << 20;

Result<ShaderModule> make_module(const Device& device, const Shader& shader) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = shader.spirv.size() * sizeof(std::uint32_t);
    info.pCode = shader.spirv.data();
    VkShaderModule module = VK_NULL_HANDLE;
    if (Status made = check(vkCreateShaderModule(device.get(), &info, nullptr, &module), shader.name); !made)
        return fail(made.error());
    return ShaderModule(device.get(), module);
}

// What a vertex shader reads must be there; what it does not read may be.
Status check_streams(const GraphicsInfo& info) {
    for (const VertexInput& input : info.vertex->reflection.inputs) {
        const bool fed =
            std::any_of(info.streams.begin(), info.streams.end(),
                        [&](const VertexStream& stream) { return stream.location == input.location; });
        if (!fed)
            return fail(ErrorCode::failed,
                        fmt::format("{}: nothing feeds the vertex input \"{}\" at location {}",
                                    info.vertex->name, input.name, input.location));
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
        if (Result<std::string> text = read_file(cache.file_, largest_cache, ErrorCode::failed))
            stored = std::move(*text);
    // The driver must refuse a foreign cache itself, but some have not: its header says whose it is.
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
    VkPipelineCache made = VK_NULL_HANDLE;
    if (Status ok =
            check(vkCreatePipelineCache(device.get(), &info, nullptr, &made), "making a pipeline cache");
        !ok)
        return fail(ok.error());
    cache.cache_ = PipelineCacheHandle(device.get(), made);
    return cache;
}

Status PipelineCache::save() const {
    if (file_.empty()) return {};
    std::size_t size = 0;
    const VkResult counted = vkGetPipelineCacheData(device_->get(), cache_.get(), &size, nullptr);
    if (Status ok = check(counted, "reading the pipeline cache"); !ok) return ok;
    std::string data(size, '\0');
    const VkResult got = vkGetPipelineCacheData(device_->get(), cache_.get(), &size, data.data());
    if (Status ok = check(got, "reading the pipeline cache"); !ok) return ok;
    data.resize(size);
    if (restored_ && size == stored_size_) return {};
    std::error_code ignored;  // write_file says why if the folder is not there
    std::filesystem::create_directories(file_.parent_path(), ignored);
    return write_file(file_, data);
}

Result<Pipeline> make_graphics_pipeline(const Device& device, const PipelineCache& cache,
                                        const GraphicsInfo& info) {
    if (Status fed = check_streams(info); !fed) return fail(fed.error());
    Pipeline pipeline;
    std::vector<const Shader*> shaders{info.vertex};
    if (info.fragment != nullptr) shaders.push_back(info.fragment);
    if (Status merged = merge_layouts(device, shaders, pipeline); !merged) return fail(merged.error());

    const VkSpecializationMapEntry entry{0, 0, sizeof info.constants};
    const VkSpecializationInfo constants{1, &entry, sizeof info.constants, &info.constants};
    std::vector<ShaderModule> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const Shader* shader : shaders) {
        Result<ShaderModule> module = make_module(device, *shader);
        if (!module) return fail(module.error());
        VkPipelineShaderStageCreateInfo stage{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        stage.stage = shader->reflection.stage;
        stage.module = module->get();
        stage.pName = "main";
        stage.pSpecializationInfo = info.constants != 0 ? &constants : nullptr;
        stages.push_back(stage);
        modules.push_back(std::move(*module));
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
    if (info.color_write)
        blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                               VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
    const std::vector<VkPipelineColorBlendAttachmentState> blends(info.colors.size(), blend);
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
    const VkResult made = vkCreateGraphicsPipelines(device.get(), cache.get(), 1, &create, nullptr, &handle);
    if (Status ok = check(made, fmt::format("making the pipeline of {}", info.vertex->name)); !ok)
        return fail(ok.error());
    pipeline.handle = PipelineHandle(device.get(), handle);
    return pipeline;
}

Result<Pipeline> make_compute_pipeline(const Device& device, const PipelineCache& cache,
                                       const Shader& shader) {
    Pipeline pipeline;
    const Shader* shaders[] = {&shader};
    if (Status merged = merge_layouts(device, shaders, pipeline); !merged) return fail(merged.error());
    Result<ShaderModule> module = make_module(device, shader);
    if (!module) return fail(module.error());
    VkComputePipelineCreateInfo create{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    create.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                    nullptr,
                    0,
                    VK_SHADER_STAGE_COMPUTE_BIT,
                    module->get(),
                    "main",
                    nullptr};
    create.layout = pipeline.layout.get();
    VkPipeline handle = VK_NULL_HANDLE;
    const VkResult made = vkCreateComputePipelines(device.get(), cache.get(), 1, &create, nullptr, &handle);
    if (Status ok = check(made, fmt::format("making the pipeline of {}", shader.name)); !ok)
        return fail(ok.error());
    pipeline.handle = PipelineHandle(device.get(), handle);
    return pipeline;
}

}  // namespace bolt::gpu
