#include "engine/gpu/swapchain.hpp"

#include <doctest/doctest.h>

using namespace bolt;
using namespace bolt::gpu;

namespace {

// The capabilities of a desktop window as many drivers report them.
SurfaceSupport desktop() {
    SurfaceSupport offer;
    VkSurfaceCapabilitiesKHR& can = offer.capabilities;
    can.minImageCount = 2;
    can.currentExtent = {640, 480};
    can.minImageExtent = {1, 1};
    can.maxImageExtent = {4096, 4096};
    can.supportedTransforms = can.currentTransform = VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR;
    can.supportedCompositeAlpha = VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR | VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    can.supportedUsageFlags = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    offer.formats = {{VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR},
                     {VK_FORMAT_B8G8R8A8_SRGB, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR}};
    offer.modes = {VK_PRESENT_MODE_FIFO_KHR, VK_PRESENT_MODE_MAILBOX_KHR, VK_PRESENT_MODE_IMMEDIATE_KHR};
    return offer;
}

SwapchainPlan plan(const SurfaceSupport& offer, const SwapchainRequest& wish = {}) {
    Result<SwapchainPlan> made = plan_swapchain(offer, wish);
    if (!made) FAIL(made.error().message());
    return *made;
}

}  // namespace

TEST_CASE(
    "Swapchain: the format is 8-bit sRGB, RGBA preferred; without one the error lists the supported "
    "formats") {
    SurfaceSupport offer = desktop();
    CHECK(plan(offer).format.format == VK_FORMAT_B8G8R8A8_SRGB);
    offer.formats.push_back({VK_FORMAT_R8G8B8A8_SRGB, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR});
    CHECK(plan(offer).format.format == VK_FORMAT_R8G8B8A8_SRGB);
    CHECK(plan(offer).reasons.front() == "format RGBA sRGB: no conversion");
    // The right format in another colour space gives wrong colours.
    offer.formats = {{VK_FORMAT_R8G8B8A8_SRGB, VK_COLOR_SPACE_DISPLAY_P3_NONLINEAR_EXT},
                     {VK_FORMAT_B8G8R8A8_UNORM, VK_COLOR_SPACE_SRGB_NONLINEAR_KHR}};
    const auto refused = plan_swapchain(offer, {});
    REQUIRE_FALSE(refused.has_value());
    CHECK(refused.error().code == ErrorCode::no_device);
    CHECK(refused.error().what.find("VkFormat: 43, 44") != std::string::npos);
    offer = desktop();
    offer.capabilities.supportedUsageFlags = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
    CHECK_FALSE(plan_swapchain(offer, {}).has_value());
}

TEST_CASE("Swapchain: the present mode is mailbox, otherwise fifo, and never one that tears") {
    SurfaceSupport offer = desktop();
    CHECK(plan(offer).mode == VK_PRESENT_MODE_MAILBOX_KHR);
    offer.modes = {VK_PRESENT_MODE_IMMEDIATE_KHR, VK_PRESENT_MODE_FIFO_RELAXED_KHR, VK_PRESENT_MODE_FIFO_KHR};
    CHECK(plan(offer).mode == VK_PRESENT_MODE_FIFO_KHR);
    CHECK(plan(offer).reasons[1].starts_with("fifo: mailbox is not available"));
}

TEST_CASE(
    "Swapchain: the images suffice for presentation, queue and drawing, within the limits of the surface") {
    SurfaceSupport offer = desktop();
    CHECK(plan(offer).images == 3);
    offer.capabilities.minImageCount = 4;
    CHECK(plan(offer).images == 5);  // mailbox needs one more than the minimum, otherwise it blocks
    offer.capabilities.maxImageCount = 4;
    CHECK(plan(offer).images == 4);
    offer = desktop();
    offer.modes = {VK_PRESENT_MODE_FIFO_KHR};
    CHECK(plan(offer).images == 2);
}

TEST_CASE(
    "Swapchain: the size is the surface's, otherwise the window's within the limits, and zero while "
    "minimised") {
    SurfaceSupport offer = desktop();
    const VkExtent2D window{800, 600};
    CHECK(plan(offer, {window, 2}).extent.width == 640);
    offer.capabilities.currentExtent = {0xFFFFFFFF, 0xFFFFFFFF};
    CHECK(plan(offer, {window, 2}).extent.width == 800);
    CHECK(plan(offer, {window, 2}).extent.height == 600);
    CHECK(plan(offer, {{9000, 600}, 2}).extent.width == 4096);
    CHECK(plan(offer, {{0, 600}, 2}).extent.width == 0);
    offer.capabilities.currentExtent = {0, 0};
    CHECK(plan(offer, {window, 2}).extent.height == 0);
}

TEST_CASE("Swapchain: the transform is identity and the composition opaque if available") {
    SurfaceSupport offer = desktop();
    CHECK(plan(offer).alpha == VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR);
    offer.capabilities.supportedCompositeAlpha = VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    CHECK(plan(offer).alpha == VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR);
    offer.capabilities.currentTransform = VK_SURFACE_TRANSFORM_ROTATE_90_BIT_KHR;
    CHECK(plan(offer).transform == VK_SURFACE_TRANSFORM_IDENTITY_BIT_KHR);
    offer.capabilities.supportedTransforms = VK_SURFACE_TRANSFORM_ROTATE_90_BIT_KHR;
    CHECK(plan(offer).transform == VK_SURFACE_TRANSFORM_ROTATE_90_BIT_KHR);
}
