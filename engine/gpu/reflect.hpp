// The interface of a shader, read from its SPIR-V. Layouts are derived from it and declared nowhere else.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

struct Binding {
    std::uint32_t set = 0, binding = 0, count = 1;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_MAX_ENUM;
    std::string name;
};

struct VertexInput {
    std::uint32_t location = 0;
    VkFormat format = VK_FORMAT_UNDEFINED;  // the shader's 32-bit type; a mesh may store a smaller one
    std::string name;
};

struct Reflection {
    VkShaderStageFlagBits stage = VK_SHADER_STAGE_VERTEX_BIT;
    std::vector<Binding> bindings;     // sorted by set, then binding
    std::vector<VertexInput> inputs;   // vertex stage only, sorted by location
    std::uint32_t push_constants = 0;  // bytes
};

Result<Reflection> reflect(std::span<const std::uint32_t> spirv);

}  // namespace bolt::gpu
