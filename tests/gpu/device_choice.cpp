#include "engine/gpu/device.hpp"

#include <doctest/doctest.h>

using namespace bolt::gpu;

namespace {

DeviceCandidate gpu(const char* name, VkPhysicalDeviceType type, std::uint64_t memory = 1000) {
    DeviceCandidate candidate;
    candidate.name = name;
    candidate.driver = "driver 1";
    candidate.type = type;
    candidate.api_version = VK_API_VERSION_1_3;
    candidate.device_memory = memory;
    return candidate;
}

const DeviceCandidate lavapipe = gpu("llvmpipe", VK_PHYSICAL_DEVICE_TYPE_CPU, 9000);
const DeviceCandidate laptop = gpu("Intel UHD", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, 8000);
const DeviceCandidate small = gpu("Card 8", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, 8);
const DeviceCandidate large = gpu("Card 24", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, 24);

}  // namespace

TEST_CASE("Device choice: the fastest type wins, then the larger memory, in any order") {
    CHECK(choose_device(std::vector{lavapipe, laptop, small, large}, "").index == 3);
    CHECK(choose_device(std::vector{large, small, laptop, lavapipe}, "").index == 0);
    CHECK(choose_device(std::vector{lavapipe, laptop}, "").index == 1);
    CHECK(choose_device(std::vector{lavapipe}, "").index == 0);
    CHECK(choose_device(std::vector<DeviceCandidate>{}, "").index == -1);
}

TEST_CASE("Device choice: unusable devices are excluded, and every candidate has a reason") {
    DeviceCandidate old = large;
    old.api_version = VK_API_VERSION_1_2;
    DeviceCandidate poor = small;
    poor.missing = {"multiview", "dynamicRendering"};
    DeviceCandidate blind = laptop;
    blind.presents = false;
    const DeviceChoice choice = choose_device(std::vector{old, poor, blind, lavapipe}, "");
    CHECK(choice.index == 3);
    REQUIRE(choice.reasons.size() == 4);
    CHECK(choice.reasons[0] == "Card 24 (discrete GPU, driver 1): supports only Vulkan 1.2, needs 1.3");
    CHECK(choice.reasons[1] == "Card 8 (discrete GPU, driver 1): lacks multiview, dynamicRendering");
    CHECK(choice.reasons[2] == "Intel UHD (integrated GPU, driver 1): cannot present to this display");
    CHECK(choice.reasons[3] == "llvmpipe (software, driver 1): used");
    CHECK(choose_device(std::vector{laptop, small}, "").reasons[0] ==
          "Intel UHD (integrated GPU, driver 1): can be used, but is not the fastest");
}

TEST_CASE("Device choice: a requested name selects matching devices, case-insensitively") {
    CHECK(choose_device(std::vector{large, lavapipe}, "LLVM").index == 1);
    const DeviceChoice none = choose_device(std::vector{large, lavapipe}, "radeon");
    CHECK(none.index == -1);
    CHECK(none.reasons[0] == "Card 24 (discrete GPU, driver 1): does not match \"radeon\"");
}
