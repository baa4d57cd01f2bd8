#include "engine/gpu/reflect.hpp"

#include <fmt/format.h>
#include <spirv_cross/spirv_cross_c.h>

#include <algorithm>
#include <memory>
#include <optional>

namespace bolt::gpu {

namespace {

using Context = std::unique_ptr<spvc_context_s, decltype(&spvc_context_destroy)>;

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
        return fail(ErrorCode::failed, "not enough memory to reflect a shader");
    const Context context(raw, spvc_context_destroy);
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
                    fmt::format("not a SPIR-V shader: {}", spvc_context_get_last_error_string(raw)));

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

}  // namespace bolt::gpu
