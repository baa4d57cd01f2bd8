#include <doctest/doctest.h>

#include "tests/support/eventually.hpp"
#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

constexpr XrResult losses[] = {XR_ERROR_SESSION_LOST, XR_ERROR_INSTANCE_LOST};

// Each function that begin(), a frame or a vibration calls.
constexpr const char* frame_functions[] = {
    "xrPollEvent",
    "xrWaitFrame",
    "xrBeginFrame",
    "xrSyncActions",
    "xrGetActionStatePose",
    "xrGetActionStateFloat",
    "xrLocateSpace",
    "xrGetActionStateBoolean",
    "xrLocateViews",
    "xrGetActionStateVector2f",
    "xrLocateHandJointsEXT",
    "xrAcquireSwapchainImage",
    "xrWaitSwapchainImage",
    "xrReleaseSwapchainImage",
    "xrEndFrame",
    "xrApplyHapticFeedback",
};
constexpr const char* begin_functions[] = {
    "xrCreateSession",
    "xrEnumerateReferenceSpaces",
    "xrCreateReferenceSpace",
    "xrEnumerateSwapchainFormats",
    "xrCreateSwapchain",
    "xrEnumerateSwapchainImages",
    "xrStringToPath",
    "xrCreateActionSet",
    "xrCreateAction",
    "xrSuggestInteractionProfileBindings",
    "xrAttachSessionActionSets",
    "xrCreateActionSpace",
    "xrCreateHandTrackerEXT",
};

void check_lost(const test::MockRuntime& mock, test::Program& program) {
    CHECK_FALSE(program.headset().connected());
    REQUIRE(program.headset().absence().has_value());
    CHECK(program.headset().absence()->lost);
    CHECK_FALSE(program.headset().exit_requested());
    CHECK(mock->instance() == XR_NULL_HANDLE);
    CHECK_FALSE(program.frame().has_value());
}

// Connects with new Vulkan objects, and shows a few frames.
void check_found(const test::MockRuntime& mock, test::Program& program) {
    const std::uint64_t devices = mock->calls("xrCreateVulkanDeviceKHR");
    REQUIRE(program.connect());
    CHECK(mock->calls("xrCreateVulkanDeviceKHR") == devices + 1);
    CHECK_FALSE(program.headset().absence().has_value());
    CHECK(program.focus().focused);
    for (int i = 0; i < 3; ++i) (void)program.frame();
}

}  // namespace

TEST_CASE("Headset: a loss in any call of a frame makes it absent, and it is found again") {
    const test::MockRuntime mock;
    test::Program program;
    mock::Hand hand;
    hand.has_joints = true;
    mock->set_hand(mock::Side::left, hand);
    check_found(mock, program);
    for (const char* function : frame_functions)
        for (const XrResult loss : losses) {
            CAPTURE(std::string(function));
            CAPTURE(loss);
            mock->fail_next(function, loss, 1);
            program.headset().vibrate(xr::Side::left, {0.5F, 0.0F, 0.1});
            for (int i = 0; i < 4 && program.headset().connected(); ++i) (void)program.frame();
            check_lost(mock, program);
            check_found(mock, program);
        }
}

TEST_CASE("Headset: a loss between drawing and submitting keeps the images until the GPU has finished") {
    for (const XrResult loss : losses) {
        const test::MockRuntime mock;
        test::Program program;
        REQUIRE(program.connect());
        (void)program.focus();
        (void)program.frame();
        program.while_drawing = [&] {
            mock->fail_next("xrApplyHapticFeedback", loss, 1);
            program.headset().vibrate(xr::Side::left, {0.5F, 0.0F, 0.1});
            program.headset().vibrate(xr::Side::left, {0.5F, 0.0F, 0.1});
        };
        CHECK(program.frame().has_value());
        program.while_drawing = {};
        check_lost(mock, program);
        check_found(mock, program);
    }
}

TEST_CASE("Headset: a loss while the session begins makes it absent, and it is found again") {
    const test::MockRuntime mock;
    test::Program program;
    for (const char* function : begin_functions)
        for (const XrResult loss : losses) {
            CAPTURE(std::string(function));
            CAPTURE(loss);
            mock->fail_next(function, loss, 1);
            CHECK_FALSE(program.connect());
            check_lost(mock, program);
        }
    check_found(mock, program);
}

TEST_CASE("Headset: a loss in the calls that start and stop the session makes it absent") {
    for (const char* function : {"xrBeginSession", "xrEndSession", "xrRequestExitSession"})
        for (const XrResult loss : losses) {
            CAPTURE(std::string(function));
            CAPTURE(loss);
            const test::MockRuntime mock;
            test::Program program;
            REQUIRE(program.connect());
            mock->fail_next(function, loss, 1);
            for (int i = 0; i < 5 && program.headset().connected(); ++i) (void)program.frame();
            mock->send(mock::Event::taken_off);
            for (int i = 0; i < 5 && program.headset().connected(); ++i) (void)program.frame();
            program.headset().end();
            CHECK_FALSE(program.headset().connected());
            CHECK(mock->instance() == XR_NULL_HANDLE);
        }
}

TEST_CASE("Headset: a runtime that announces a loss is left at once") {
    for (const mock::Event event : {mock::Event::session_loss, mock::Event::instance_loss}) {
        const test::MockRuntime mock;
        test::Program program;
        REQUIRE(program.connect());
        (void)program.focus();
        mock->send(event);
        for (int i = 0; i < 2 && program.headset().connected(); ++i) (void)program.frame();
        check_lost(mock, program);
        check_found(mock, program);
    }
}

TEST_CASE("Headset: errors of a search leave nothing behind") {
    const test::MockRuntime mock;
    test::Program program;
    for (const char* function : {"xrCreateInstance", "xrGetInstanceProperties", "xrGetSystem",
                                 "xrGetSystemProperties", "xrEnumerateViewConfigurations",
                                 "xrEnumerateViewConfigurationViews", "xrEnumerateEnvironmentBlendModes"}) {
        CAPTURE(std::string(function));
        mock->fail_next(function, XR_ERROR_INSTANCE_LOST, 1);
        CHECK_FALSE(program.connect());
        CHECK(program.headset().absence().has_value());
        CHECK(mock->instance() == XR_NULL_HANDLE);
    }
    check_found(mock, program);
}

TEST_CASE("Headset: other errors of a frame also make it absent") {
    const test::MockRuntime mock;
    test::Program program;
    for (const char* function : frame_functions) {
        CAPTURE(std::string(function));
        check_found(mock, program);
        mock->fail_next(function, XR_ERROR_RUNTIME_FAILURE, 1);
        program.headset().vibrate(xr::Side::left, {0.5F, 0.0F, 0.1});
        for (int i = 0; i < 4 && program.headset().connected(); ++i) (void)program.frame();
        CHECK_FALSE(program.headset().connected());
        CHECK(mock->instance() == XR_NULL_HANDLE);
    }
}

TEST_CASE(
    "Headset: a headset that is lost while its runtime hangs is left at once, and found when it returns") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->block_wait(true);
    (void)program.frame();  // the one that was waited for already
    mock->fail_next("xrPollEvent", XR_ERROR_RUNTIME_FAILURE, 1);
    CHECK_FALSE(program.headset().begin_frame(0.0).has_value());
    CHECK_FALSE(program.headset().connected());
    CHECK(mock->waiting());
    CHECK_FALSE(program.connect());  // it is not searched while a thread is inside the runtime
    mock->block_wait(false);
    CHECK(test::eventually([&] {
        (void)program.headset().begin_frame(0.0);
        return mock->instance() == XR_NULL_HANDLE;
    }));
    check_found(mock, program);
}

TEST_CASE("Headset: a runtime that never returns from xrWaitFrame blocks neither frames nor the end") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock->block_wait(true);
    (void)program.frame();  // the one that was waited for already
    for (int i = 0; i < 3; ++i) CHECK_FALSE(program.headset().begin_frame(0.01).has_value());
    CHECK(program.headset().connected());
    program.headset().end();
    CHECK_FALSE(program.headset().connected());
    // The instance is left alone, so no other can be created.
    CHECK(mock->instance() != XR_NULL_HANDLE);
    CHECK(mock->calls("xrDestroySession") == 0);
    CHECK(mock->calls("xrDestroySwapchain") == 0);
    CHECK(mock->calls("xrDestroySpace") == 0);
    CHECK_FALSE(program.connect());
    CHECK(program.headset().absence()->message().find("XR_ERROR_LIMIT_REACHED") != std::string::npos);

    mock->block_wait(false);
    CHECK(test::eventually([&] { return !mock->waiting(); }));
    REQUIRE(program.device().idle().has_value());
    CHECK(xrDestroyInstance(mock->instance()) == XR_SUCCESS);
    const std::vector<std::string> violations = mock->take_violations();
    CHECK(violations.size() == 5);  // what was left: a session, spaces, swapchains, actions, hand trackers
    CHECK(mock->calls("xrDestroyInstance") == 1);
}
