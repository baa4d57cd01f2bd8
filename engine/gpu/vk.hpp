// Vulkan 1.3 through volk. Entry points are loaded at run time, so the programs start on machines without
// Vulkan and can report that it is missing.
#pragma once

#define VK_NO_PROTOTYPES
#include <volk.h>

#include <cstdint>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::gpu {

// The name in the specification: "VK_ERROR_DEVICE_LOST".
std::string_view name(VkResult result);

// Returns an Error for every result that is not a success. Lost and missing devices have the code no_device.
// `Error::lost` is set for a lost device, but not for a lost surface, which Swapchain recreates.
Status check(VkResult result, std::string_view what);

// Fills `values` by a Vulkan function that is called twice: for the count, then for the values.
// `query`: VkResult(std::uint32_t* count, T* values).
template <class T, class Query>
VkResult enumerate(std::vector<T>& values, const Query& query) {
    VkResult result = VK_INCOMPLETE;
    while (result == VK_INCOMPLETE) {  // the list may have grown between the calls
        std::uint32_t count = 0;
        result = query(&count, nullptr);
        values.resize(count);
        if (result == VK_SUCCESS && count > 0) result = query(&count, values.data());
        values.resize(count);
    }
    return result;
}

}  // namespace bolt::gpu
