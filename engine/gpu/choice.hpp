// Which GPU to use, and why: a pure function over what the machine has, so that it can be tested without one.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/gpu/vk.hpp"

namespace bolt::gpu {

// What the choice depends on.
struct Candidate {
    std::string name;
    std::string driver;
    VkPhysicalDeviceType type = VK_PHYSICAL_DEVICE_TYPE_OTHER;
    std::uint32_t api_version = 0;
    std::vector<std::string> missing;  // required features and extensions that it lacks
    std::uint64_t device_memory = 0;   // bytes of the largest device-local heap
    bool presents = true;              // to the window that is asked for; true without a window
};

struct Choice {
    int index = -1;                    // −1: none can be used
    std::vector<std::string> reasons;  // one line a candidate: used, or why not
};

// The fastest kind that can do the work: discrete, integrated, virtual, software; then the one with more
// memory. `wanted` (part of a name, any case; may be empty) leaves only those.
Choice choose(std::span<const Candidate> candidates, const std::string& wanted);

}  // namespace bolt::gpu
