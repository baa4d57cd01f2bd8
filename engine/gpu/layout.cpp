#include "engine/gpu/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace bolt::gpu {

Status merge_layouts(const Device& device, std::span<const Shader* const> shaders, Pipeline& pipeline) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<Binding, VkShaderStageFlags>> merged;
    std::uint32_t sets = 0;
    for (const Shader* shader : shaders) {
        const Reflection& r = shader->reflection;
        for (const Binding& binding : r.bindings) {
            const auto [place, fresh] =
                merged.try_emplace({binding.set, binding.binding}, binding, VkShaderStageFlags{0});
            const Binding& known = place->second.first;
            if (!fresh && (known.type != binding.type || known.count != binding.count))
                return fail(ErrorCode::failed,
                            fmt::format("{}: set {} binding {} (\"{}\") is something else in another stage",
                                        shader->name, binding.set, binding.binding, binding.name));
            place->second.second |= static_cast<VkShaderStageFlags>(r.stage);
            sets = std::max(sets, binding.set + 1);
        }
        if (r.push_constants > 0) {
            pipeline.push_stages |= static_cast<VkShaderStageFlags>(r.stage);
            pipeline.push_size = std::max(pipeline.push_size, r.push_constants);
        }
    }
    if (pipeline.push_size > device.limits().maxPushConstantsSize)
        return fail(ErrorCode::failed,
                    fmt::format("{} bytes of push constants are more than the GPU takes ({})",
                                pipeline.push_size, device.limits().maxPushConstantsSize));

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
        const VkResult made = vkCreateDescriptorSetLayout(device.get(), &info, nullptr, &layout);
        if (Status ok = check(made, "making a descriptor set layout"); !ok) return ok;
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
    if (Status ok =
            check(vkCreatePipelineLayout(device.get(), &info, nullptr, &layout), "making a pipeline layout");
        !ok)
        return ok;
    pipeline.layout = PipelineLayout(device.get(), layout);
    return {};
}

}  // namespace bolt::gpu
