// Lists that Vulkan functions give when they are called twice: for the length, then for what is in them.
#pragma once

#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// `ask`: VkResult(std::uint32_t* count, T* values).
template <class T, class Ask>
VkResult listed(std::vector<T>& values, const Ask& ask) {
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {  // it may have grown between the calls
        std::uint32_t count = 0;
        result = ask(&count, nullptr);
        values.resize(count);
        if (result == VK_SUCCESS && count > 0) result = ask(&count, values.data());
        values.resize(count);
    }
    return result;
}

}  // namespace bolt::gpu
