// Each check of the mock's frame loop, swapchains and layers finds a client that breaks its rule.
#include <doctest/doctest.h>

#include <thread>

#include "tests/support/eventually.hpp"
#include "tests/xr/direct.hpp"

using namespace bolt;

namespace {

// A frame that is begun, with a layer that is right; a test spoils it.
struct Submission {
    explicit Submission(const std::vector<const char*>& extensions = {"XR_KHR_vulkan_enable2",
                                                                      "XR_KHR_composition_layer_depth"}) {
        REQUIRE(client.make_instance(extensions) == XR_SUCCESS);
        client.run_session();
        space = client.make_space();
        color = client.make_swapchain(test::DirectClient::color_format, 2);
        depth = client.make_swapchain(test::DirectClient::depth_format, 2);
        for (const XrSwapchain swapchain : {color, depth}) {
            REQUIRE(client.acquire(swapchain) == XR_SUCCESS);
            REQUIRE(client.wait_image(swapchain) == XR_SUCCESS);
            REQUIRE(client.release(swapchain) == XR_SUCCESS);
        }
        for (std::uint32_t eye = 0; eye < 2; ++eye) {
            depths[eye].subImage = {depth, {{0, 0}, {64, 48}}, eye};
            depths[eye].minDepth = 0.0F;
            depths[eye].maxDepth = 1.0F;
            depths[eye].nearZ = 100.0F;
            depths[eye].farZ = 0.1F;
            views[eye].next = &depths[eye];
            views[eye].pose.orientation.w = 1.0F;
            views[eye].fov = {-0.5F, 0.5F, 0.5F, -0.5F};
            views[eye].subImage = {color, {{0, 0}, {64, 48}}, eye};
        }
        projection.space = space;
        projection.viewCount = 2;
        projection.views = views;
        REQUIRE(client.wait_frame() == XR_SUCCESS);
        REQUIRE(client.begin_frame() == XR_SUCCESS);
    }
    XrResult end() {
        return client.end_frame(client.display_time,
                                {reinterpret_cast<const XrCompositionLayerBaseHeader*>(&projection)});
    }

    test::DirectClient client;
    XrSpace space = XR_NULL_HANDLE;
    XrSwapchain color = XR_NULL_HANDLE, depth = XR_NULL_HANDLE;
    XrCompositionLayerDepthInfoKHR depths[2]{{XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR},
                                             {XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR}};
    XrCompositionLayerProjectionView views[2]{{XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW},
                                              {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW}};
    XrCompositionLayerProjection projection{XR_TYPE_COMPOSITION_LAYER_PROJECTION};
};

}  // namespace

TEST_CASE("Mock: a frame that is right breaks no rule") {
    const test::MockRuntime mock;
    Submission frame;
    CHECK(frame.end() == XR_SUCCESS);
    CHECK(mock->take_violations().empty());
    CHECK(mock->take_frames().size() == 1);
}

TEST_CASE("Mock: the order of wait, begin and end is checked") {
    const test::MockRuntime mock;
    test::DirectClient client;
    REQUIRE(client.make_session() == XR_SUCCESS);
    test::expect_violation(mock, client.wait_frame(), XR_ERROR_SESSION_NOT_RUNNING,
                           "xrWaitFrame: is called while the session does not run");
    test::expect_violation(mock, client.begin_frame(), XR_ERROR_SESSION_NOT_RUNNING,
                           "xrBeginFrame: is called while the session does not run");
    test::expect_violation(mock, client.end_frame(1), XR_ERROR_SESSION_NOT_RUNNING,
                           "xrEndFrame: is called while the session does not run");
    client.run_session();
    test::expect_violation(mock, client.begin_frame(), XR_ERROR_CALL_ORDER_INVALID,
                           "xrBeginFrame: is called without xrWaitFrame");
    REQUIRE(client.wait_frame() == XR_SUCCESS);
    test::expect_violation(mock, client.end_frame(client.display_time), XR_ERROR_CALL_ORDER_INVALID,
                           "xrEndFrame: is called without xrBeginFrame");
    REQUIRE(client.begin_frame() == XR_SUCCESS);
    test::expect_violation(mock, client.begin_frame(), XR_ERROR_CALL_ORDER_INVALID,
                           "xrBeginFrame: is called without xrWaitFrame");
    test::expect_violation(mock, client.end_frame(client.display_time + 1), XR_ERROR_TIME_INVALID,
                           "xrEndFrame: submits another display time than xrWaitFrame gave");
    test::expect_violation(
        mock, client.end_frame(client.display_time, {}, XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND),
        XR_ERROR_ENVIRONMENT_BLEND_MODE_UNSUPPORTED, "xrEndFrame: submits a blend mode that is not offered");
    CHECK(client.end_frame(client.display_time) == XR_SUCCESS);
    // A frame that is begun twice without an end is discarded; that is allowed.
    REQUIRE(client.wait_frame() == XR_SUCCESS);
    REQUIRE(client.begin_frame() == XR_SUCCESS);
    REQUIRE(client.wait_frame() == XR_SUCCESS);
    CHECK(client.begin_frame() == XR_FRAME_DISCARDED);
    CHECK(mock->take_violations().empty());
}

TEST_CASE("Mock: xrWaitFrame blocks until the last frame has begun, for one thread at a time") {
    const test::MockRuntime mock;
    test::DirectClient client;
    client.run_session();
    REQUIRE(client.wait_frame() == XR_SUCCESS);
    const XrTime first = client.display_time;
    std::thread other([&] { (void)client.wait_frame(); });
    CHECK(test::eventually([&] { return mock->waiting(); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    CHECK(mock->waiting());
    std::thread third([&] {
        const XrFrameWaitInfo info{XR_TYPE_FRAME_WAIT_INFO, nullptr};
        XrFrameState state{XR_TYPE_FRAME_STATE};
        (void)client.call<PFN_xrWaitFrame>("xrWaitFrame", client.session, &info, &state);
    });
    CHECK(test::eventually([&] { return mock->calls("xrWaitFrame") == 3; }));
    CHECK(client.begin_frame() == XR_SUCCESS);
    CHECK(test::eventually([&] { return client.begin_frame() == XR_FRAME_DISCARDED; }));
    other.join();
    third.join();
    CHECK(client.display_time > first);
    const std::vector<std::string> violations = mock->take_violations();
    REQUIRE_FALSE(violations.empty());
    CHECK(violations[0] == "xrWaitFrame: is called by two threads at once");
}

TEST_CASE("Mock: a session that is destroyed while a thread waits for its frame is found") {
    const test::MockRuntime mock;
    test::DirectClient client;
    client.run_session();
    mock->block_wait(true);
    XrResult waited = XR_SUCCESS;
    std::thread other([&] { waited = client.wait_frame(); });
    CHECK(test::eventually([&] { return mock->waiting(); }));
    mock->fail_next("xrDestroySession", XR_ERROR_RUNTIME_FAILURE, 1);
    test::expect_violation(mock, client.call<PFN_xrDestroySession>("xrDestroySession", client.session),
                           XR_ERROR_RUNTIME_FAILURE,
                           "xrDestroySession: is called while a thread is inside xrWaitFrame");
    other.join();
    CHECK(waited == XR_ERROR_SESSION_LOST);
}

TEST_CASE("Mock: the order of acquire, wait and release is checked") {
    const test::MockRuntime mock;
    test::DirectClient client;
    client.run_session();
    const XrSwapchain swapchain = client.make_swapchain(test::DirectClient::color_format, 1);
    test::expect_violation(
        mock, client.wait_image(swapchain), XR_ERROR_CALL_ORDER_INVALID,
        "xrWaitSwapchainImage: is called without an acquired image that was not waited for");
    test::expect_violation(mock, client.release(swapchain), XR_ERROR_CALL_ORDER_INVALID,
                           "xrReleaseSwapchainImage: is called without an image that was waited for");
    REQUIRE(client.acquire(swapchain) == XR_SUCCESS);
    test::expect_violation(mock, client.release(swapchain), XR_ERROR_CALL_ORDER_INVALID,
                           "xrReleaseSwapchainImage: is called without an image that was waited for");
    REQUIRE(client.wait_image(swapchain) == XR_SUCCESS);
    test::expect_violation(
        mock, client.wait_image(swapchain), XR_ERROR_CALL_ORDER_INVALID,
        "xrWaitSwapchainImage: is called without an acquired image that was not waited for");
    REQUIRE(client.acquire(swapchain) == XR_SUCCESS);
    REQUIRE(client.acquire(swapchain) == XR_SUCCESS);
    test::expect_violation(mock, client.acquire(swapchain), XR_ERROR_CALL_ORDER_INVALID,
                           "xrAcquireSwapchainImage: is called while all images are acquired");
    CHECK(client.release(swapchain) == XR_SUCCESS);
}

TEST_CASE("Mock: what swapchains may be is checked") {
    const test::MockRuntime mock;
    test::DirectClient client;
    REQUIRE(client.make_session() == XR_SUCCESS);
    XrSwapchainCreateInfo right{XR_TYPE_SWAPCHAIN_CREATE_INFO};
    right.format = test::DirectClient::color_format;
    right.width = right.height = 16;
    right.arraySize = right.sampleCount = right.faceCount = right.mipCount = 1;
    const auto create = [&](const XrSwapchainCreateInfo& info) {
        XrSwapchain swapchain = XR_NULL_HANDLE;
        return client.call<PFN_xrCreateSwapchain>("xrCreateSwapchain", client.session, &info, &swapchain);
    };
    XrSwapchainCreateInfo wrong = right;
    wrong.format = VK_FORMAT_R8G8B8A8_UNORM;
    test::expect_violation(mock, create(wrong), XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED,
                           "xrCreateSwapchain: requests a format that is not offered");
    wrong = right;
    wrong.width = 257;
    test::expect_violation(mock, create(wrong), XR_ERROR_VALIDATION_FAILURE,
                           "xrCreateSwapchain: requests a size beyond the largest one");
    wrong = right;
    wrong.sampleCount = 4;
    test::expect_violation(mock, create(wrong), XR_ERROR_FEATURE_UNSUPPORTED,
                           "xrCreateSwapchain: requests samples, faces or mips");
}

TEST_CASE("Mock: layers are checked") {
    const test::MockRuntime mock;
    Submission frame;
    const auto spoiled = [&](auto& value, auto wrong, XrResult result, const std::string& sentence) {
        const auto right = value;
        value = wrong;
        test::expect_violation(mock, frame.end(), result, "xrEndFrame: " + sentence);
        value = right;
    };
    XrCompositionLayerProjectionView& view = frame.views[1];
    spoiled(frame.projection.type, XR_TYPE_COMPOSITION_LAYER_CUBE_KHR, XR_ERROR_LAYER_INVALID,
            "submits a layer of a type that is not offered");
    spoiled(frame.projection.viewCount, 1U, XR_ERROR_VALIDATION_FAILURE,
            "submits a view too few or too many");
    spoiled(view.subImage.swapchain, frame.client.make_swapchain(test::DirectClient::color_format, 2),
            XR_ERROR_LAYER_INVALID, "shows a swapchain of which no image was released");
    spoiled(view.subImage.swapchain, reinterpret_cast<XrSwapchain>(0x1234567), XR_ERROR_LAYER_INVALID,
            "uses a handle of no object");
    spoiled(view.subImage.swapchain, frame.depth, XR_ERROR_LAYER_INVALID,
            "shows an image of depth as a picture");
    spoiled(frame.depths[0].subImage.swapchain, frame.color, XR_ERROR_LAYER_INVALID,
            "shows depth from an image of colours");
    spoiled(view.subImage.imageRect.extent.width, 65, XR_ERROR_LAYER_INVALID,
            "shows a rectangle outside the image");
    spoiled(view.subImage.imageRect.offset.y, -1, XR_ERROR_LAYER_INVALID,
            "shows a rectangle outside the image");
    spoiled(view.subImage.imageRect.extent.height, 0, XR_ERROR_LAYER_INVALID,
            "shows a rectangle outside the image");
    spoiled(view.subImage.imageArrayIndex, 2U, XR_ERROR_LAYER_INVALID,
            "shows a layer beyond the image's last");
    spoiled(view.pose.orientation.w, 1.2F, XR_ERROR_POSE_INVALID,
            "submits an orientation that is not a unit quaternion");
    spoiled(view.fov.angleLeft, 0.6F, XR_ERROR_VALIDATION_FAILURE,
            "submits angles of view that are no frustum");
    spoiled(view.fov.angleUp, 1.6F, XR_ERROR_VALIDATION_FAILURE,
            "submits angles of view that are no frustum");
    spoiled(frame.depths[0].minDepth, 1.0F, XR_ERROR_VALIDATION_FAILURE,
            "submits a range of depth that is empty or outside 0 to 1");
    spoiled(frame.depths[1].maxDepth, 1.5F, XR_ERROR_VALIDATION_FAILURE,
            "submits a range of depth that is empty or outside 0 to 1");
    spoiled(frame.depths[0].nearZ, -1.0F, XR_ERROR_VALIDATION_FAILURE,
            "submits distances of depth that are equal or negative");
    spoiled(frame.depths[0].nearZ, 0.1F, XR_ERROR_VALIDATION_FAILURE,
            "submits distances of depth that are equal or negative");
    spoiled(frame.projection.space, XrSpace{XR_NULL_HANDLE}, XR_ERROR_LAYER_INVALID,
            "uses a handle of no object");
    CHECK(frame.end() == XR_SUCCESS);
}

TEST_CASE("Mock: depth needs its extension") {
    const test::MockRuntime mock;
    Submission frame({"XR_KHR_vulkan_enable2"});
    test::expect_violation(mock, frame.end(), XR_ERROR_VALIDATION_FAILURE,
                           "xrEndFrame: submits depth without having enabled its extension");
}
