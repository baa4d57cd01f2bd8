#define VOLK_IMPLEMENTATION
#include "engine/gpu/vk.hpp"

#include <fmt/format.h>

namespace bolt::gpu {

std::string_view name(VkResult result) {
#define BOLT_NAME(value) \
    case value:          \
        return #value;
    switch (result) {
        BOLT_NAME(VK_SUCCESS)
        BOLT_NAME(VK_NOT_READY)
        BOLT_NAME(VK_TIMEOUT)
        BOLT_NAME(VK_INCOMPLETE)
        BOLT_NAME(VK_SUBOPTIMAL_KHR)
        BOLT_NAME(VK_ERROR_OUT_OF_HOST_MEMORY)
        BOLT_NAME(VK_ERROR_OUT_OF_DEVICE_MEMORY)
        BOLT_NAME(VK_ERROR_INITIALIZATION_FAILED)
        BOLT_NAME(VK_ERROR_DEVICE_LOST)
        BOLT_NAME(VK_ERROR_MEMORY_MAP_FAILED)
        BOLT_NAME(VK_ERROR_LAYER_NOT_PRESENT)
        BOLT_NAME(VK_ERROR_EXTENSION_NOT_PRESENT)
        BOLT_NAME(VK_ERROR_FEATURE_NOT_PRESENT)
        BOLT_NAME(VK_ERROR_INCOMPATIBLE_DRIVER)
        BOLT_NAME(VK_ERROR_TOO_MANY_OBJECTS)
        BOLT_NAME(VK_ERROR_FORMAT_NOT_SUPPORTED)
        BOLT_NAME(VK_ERROR_OUT_OF_POOL_MEMORY)
        BOLT_NAME(VK_ERROR_FRAGMENTED_POOL)
        BOLT_NAME(VK_ERROR_FRAGMENTATION)
        BOLT_NAME(VK_ERROR_SURFACE_LOST_KHR)
        BOLT_NAME(VK_ERROR_NATIVE_WINDOW_IN_USE_KHR)
        BOLT_NAME(VK_ERROR_OUT_OF_DATE_KHR)
        default:
            return "VK_ERROR_UNKNOWN";
    }
#undef BOLT_NAME
}

Status check(VkResult result, std::string_view what) {
    if (result >= 0) return {};
    const bool device_missing = result == VK_ERROR_DEVICE_LOST || result == VK_ERROR_INITIALIZATION_FAILED ||
                                result == VK_ERROR_INCOMPATIBLE_DRIVER || result == VK_ERROR_SURFACE_LOST_KHR;
    Error error;
    error.code = device_missing ? ErrorCode::no_device : ErrorCode::failed;
    error.what = fmt::format("{}: {}", what, name(result));
    const bool no_memory = result == VK_ERROR_OUT_OF_HOST_MEMORY || result == VK_ERROR_OUT_OF_DEVICE_MEMORY;
    error.expected = no_memory        ? "more free memory"
                     : device_missing ? "a working GPU and its driver"
                                      : "a driver of Vulkan that works (`boltwright doctor` lists the GPUs)";
    error.lost = result == VK_ERROR_DEVICE_LOST;
    return fail(std::move(error));
}

}  // namespace bolt::gpu
