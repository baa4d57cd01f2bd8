#include "engine/gpu/choice.hpp"

#include <doctest/doctest.h>

using namespace bolt::gpu;

namespace {

Candidate gpu(const char* name, VkPhysicalDeviceType type, std::uint64_t memory = 1000) {
    Candidate candidate;
    candidate.name = name;
    candidate.driver = "driver 1";
    candidate.type = type;
    candidate.api_version = VK_API_VERSION_1_3;
    candidate.device_memory = memory;
    return candidate;
}

const Candidate lavapipe = gpu("llvmpipe", VK_PHYSICAL_DEVICE_TYPE_CPU, 9000);
const Candidate laptop = gpu("Intel UHD", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, 8000);
const Candidate small = gpu("Card 8", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, 8);
const Candidate large = gpu("Card 24", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, 24);

}  // namespace

TEST_CASE("the fastest kind first, then the larger memory, whatever the order") {
    CHECK(choose(std::vector{lavapipe, laptop, small, large}, "").index == 3);
    CHECK(choose(std::vector{large, small, laptop, lavapipe}, "").index == 0);
    CHECK(choose(std::vector{lavapipe, laptop}, "").index == 1);
    CHECK(choose(std::vector{lavapipe}, "").index == 0);
    CHECK(choose(std::vector<Candidate>{}, "").index == -1);
}

TEST_CASE("what cannot do the work is left out, and every candidate has its reason") {
    Candidate old = large;
    old.api_version = VK_API_VERSION_1_2;
    Candidate poor = small;
    poor.missing = {"multiview", "dynamicRendering"};
    Candidate blind = laptop;
    blind.presents = false;
    const Choice choice = choose(std::vector{old, poor, blind, lavapipe}, "");
    CHECK(choice.index == 3);
    REQUIRE(choice.reasons.size() == 4);
    CHECK(choice.reasons[0] == "Card 24 (discrete GPU, driver 1): speaks Vulkan 1.2, needed is 1.3");
    CHECK(choice.reasons[1] == "Card 8 (discrete GPU, driver 1): lacks multiview, dynamicRendering");
    CHECK(choice.reasons[2] == "Intel UHD (integrated GPU, driver 1): cannot show on this display");
    CHECK(choice.reasons[3] == "llvmpipe (software, driver 1): used");
    CHECK(choose(std::vector{laptop, small}, "").reasons[0] ==
          "Intel UHD (integrated GPU, driver 1): can be used, but is not the fastest");
}

TEST_CASE("a wanted name leaves only those, in any case") {
    CHECK(choose(std::vector{large, lavapipe}, "LLVM").index == 1);
    const Choice none = choose(std::vector{large, lavapipe}, "radeon");
    CHECK(none.index == -1);
    CHECK(none.reasons[0] == "Card 24 (discrete GPU, driver 1): not the one asked for (\"radeon\")");
}
