// Chooses a GPU and explains the choice. A pure function over descriptions of the devices, so that tests need
// no GPU.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// The properties of a device that the choice depends on.
struct DeviceCandidate {
    std::string name;
    std::string driver;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::uint32_t api_version = 0;
    std::vector<std::string> missing;  // required features and extensions that the device lacks
    std::uint64_t device_memory = 0;   // bytes of the largest device-local heap
    bool presents = true;              // can present to the requested window; true without a window
};

struct DeviceChoice {
    int index = -1;                    // -1: no device is usable
    std::vector<std::string> reasons;  // one line per candidate: used, or why not
};

// Chooses by type (discrete, integrated, virtual, software), then by memory size. If `wanted` is not empty,
// only devices whose name contains it (case-insensitive) are considered.
DeviceChoice choose_device(std::span<const DeviceCandidate> candidates, const std::string& wanted);

}  // namespace bolt::gpu
