#include "engine/gpu/device_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace bolt::gpu {

namespace {

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

struct Kind {
    int rank;
    const char* name;
};

Kind kind(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return {4, "discrete GPU"};
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return {3, "integrated GPU"};
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return {2, "virtual GPU"};
        case VK_PHYSICAL_DEVICE_TYPE_CPU:
            return {1, "software"};
        default:
            return {0, "other"};
    }
}

// Returns why the device cannot be used; empty: it can.
std::string objection(const DeviceCandidate& candidate, const std::string& wanted) {
    if (!wanted.empty() && lower(candidate.name).find(lower(wanted)) == std::string::npos)
        return fmt::format("does not match \"{}\"", wanted);
    if (candidate.api_version < VK_API_VERSION_1_3)
        return fmt::format("supports only Vulkan {}.{}, needs 1.3",
                           VK_API_VERSION_MAJOR(candidate.api_version),
                           VK_API_VERSION_MINOR(candidate.api_version));
    if (!candidate.missing.empty()) return fmt::format("lacks {}", fmt::join(candidate.missing, ", "));
    if (!candidate.presents) return "cannot present to this display";
    return {};
}

}  // namespace

DeviceChoice choose_device(std::span<const DeviceCandidate> candidates, const std::string& wanted) {
    DeviceChoice choice;
    std::vector<std::string> objections;
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const DeviceCandidate& candidate = candidates[i];
        objections.push_back(objection(candidate, wanted));
        if (!objections.back().empty()) continue;
        const auto value = [](const DeviceCandidate& c) {
            return std::pair{kind(c.type).rank, c.device_memory};
        };
        if (choice.index < 0 || value(candidate) > value(candidates[static_cast<std::size_t>(choice.index)]))
            choice.index = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const std::string verdict = !objections[i].empty() ? objections[i]
                                    : static_cast<int>(i) == choice.index
                                        ? std::string("used")
                                        : std::string("can be used, but is not the fastest");
        choice.reasons.push_back(fmt::format("{} ({}, {}): {}", candidates[i].name,
                                             kind(candidates[i].type).name, candidates[i].driver, verdict));
    }
    return choice;
}

}  // namespace bolt::gpu
