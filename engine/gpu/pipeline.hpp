// Shaders, the reflection of their interfaces, and pipelines created from them.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// A resource that a shader declares. `count`: the number of array elements, 1 without an array.
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

// The interface of a shader, read from its SPIR-V. Layouts are derived from it and declared nowhere else.
struct Reflection {
    VkShaderStageFlagBits stage = VK_SHADER_STAGE_VERTEX_BIT;
    std::vector<Binding> bindings;     // sorted by set, then binding
    std::vector<VertexInput> inputs;   // vertex stage only, sorted by location
    std::uint32_t push_constants = 0;  // bytes
};

// Fails if the words are not SPIR-V, or if the stage is not vertex, fragment or compute.
Result<Reflection> reflect(std::span<const std::uint32_t> spirv);

struct Shader {
    std::string name;  // for error messages: "scene.vert"
    std::vector<std::uint32_t> spirv;
    Reflection reflection;
};

Result<Shader> make_shader(std::string name, std::span<const std::uint32_t> spirv);

// The buffer, offset and format of one vertex input.
struct VertexStream {
    std::uint32_t location = 0;
    VkFormat format = VK_FORMAT_UNDEFINED;
    std::uint32_t buffer = 0;  // index of the vertex buffer
    std::uint32_t offset = 0;
};

// The description of a graphics pipeline. Its layouts come from shader reflection. Viewport and scissor are
// dynamic, and dynamic rendering replaces render pass objects.
struct GraphicsInfo {
    const Shader* vertex = nullptr;
    const Shader* fragment = nullptr;  // null: depth only
    std::vector<VertexStream> streams;
    std::vector<std::uint32_t> strides;  // bytes, one per vertex buffer
    std::vector<VkFormat> colors;        // formats of the colour targets
    VkFormat depth = VK_FORMAT_UNDEFINED;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    std::uint32_t view_mask = 0;  // bit i: multiview draws view i; 0: no multiview
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkCullModeFlags cull = VK_CULL_MODE_BACK_BIT;
    bool depth_test = true, depth_write = true;
    VkCompareOp depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;  // reversed depth: 1 near, 0 far
    bool depth_clamp = false;
    float depth_bias = 0.0F, depth_bias_slope = 0.0F;
    bool blend = false;                  // premultiplied alpha
    std::uint32_t written_colors = ~0U;  // bit i: the fragment stage writes to target i
    std::uint32_t constants = 0;  // value of specialization constant 0 in both shaders; 0: not specialized
};

struct Pipeline {
    PipelineHandle handle;
    PipelineLayout layout;
    std::vector<DescriptorSetLayout> sets;
    std::vector<Binding> bindings;  // of both stages, merged
    VkShaderStageFlags push_stages = 0;
    std::uint32_t push_size = 0;
};

// Compiled pipelines, stored on disk for the next start. A damaged file or one of another driver is ignored.
class PipelineCache {
  public:
    // Empty `file`: the cache exists in memory only.
    static Result<PipelineCache> open(const Device& device, std::filesystem::path file);
    // Writes the cache to its file, unless open() restored it and its size is still the same. The caller may
    // ignore an error.
    Status save() const;
    [[nodiscard]] VkPipelineCache get() const { return cache_.get(); }
    [[nodiscard]] bool restored() const { return restored_; }  // open() used the file's contents

  private:
    const Device* device_ = nullptr;
    std::filesystem::path file_;
    PipelineCacheHandle cache_;
    bool restored_ = false;
    std::size_t stored_size_ = 0;
};

// Creates the descriptor set layouts and the pipeline layout that the shaders need together. Fails if two
// stages declare one binding with different types or counts.
Status make_pipeline_layout(const Device& device, std::span<const Shader* const> shaders, Pipeline& pipeline);

Result<Pipeline> make_graphics_pipeline(const Device& device, const PipelineCache& cache,
                                        const GraphicsInfo& info);
// `constants`: value of specialization constant 0; 0: not specialized.
Result<Pipeline> make_compute_pipeline(const Device& device, const PipelineCache& cache, const Shader& shader,
                                       std::uint32_t constants = 0);

}  // namespace bolt::gpu
