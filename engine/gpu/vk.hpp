// Vulkan 1.3 through volk: entry points are loaded at run time, so the programs start (and explain
// themselves) where there is no Vulkan at all.
#pragma once

#define VK_NO_PROTOTYPES
#include <volk.h>

#include <string_view>

#include "engine/base/result.hpp"

namespace bolt::gpu {

// The specification's name of a result, "VK_ERROR_DEVICE_LOST".
std::string_view name(VkResult result);

// An Error for every result that is not a success. Lost devices and missing ones are ErrorCode::no_device; of
// a lost device (not a lost surface, which Swapchain replaces itself) the error says so in `lost`.
Status check(VkResult result, std::string_view what);

}  // namespace bolt::gpu
