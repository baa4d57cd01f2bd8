// The head of a viewer of projection walls, tracked by an OpenXR runtime without pictures.
#include "engine/xr/pose_tracker.hpp"

#include <doctest/doctest.h>

#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

const Pose somewhere{{0.3, 1.7, -0.4}, rotation({0.1, -0.4, 0.2})};

std::unique_ptr<xr::PoseTracker> opened(xr::TrackedDevice device) {
    auto tracker = xr::PoseTracker::open(device);
    REQUIRE_MESSAGE(tracker, (tracker ? "" : tracker.error().message()));
    return std::move(*tracker);
}

std::optional<Pose> pose_of(xr::PoseTracker& tracker) {
    const auto pose = tracker.read();
    REQUIRE_MESSAGE(pose, (pose ? "" : pose.error().message()));
    return *pose;
}

void check_same(const std::optional<Pose>& pose, const Pose& expected) {
    REQUIRE(pose.has_value());
    CHECK(glm::length(pose->position - expected.position) < 1e-6);
    CHECK(glm::length(turn_between(pose->orientation, expected.orientation)) < 1e-5);
}

}  // namespace

TEST_CASE("PoseTracker: the headset's pose in the stage, without pictures and frames") {
    const test::MockRuntime mock;
    mock->set_head({somewhere});
    const auto tracker = opened(xr::TrackedDevice::headset);
    check_same(pose_of(*tracker), somewhere);
    const Pose moved{{-0.2, 1.5, 0.1}, rotation({0.0, 1.0, 0.0})};
    mock->set_head({moved});
    check_same(pose_of(*tracker), moved);
    CHECK(mock->calls("xrWaitFrame") == 0);
}

TEST_CASE("PoseTracker: the controller that is fixed to the glasses, of one hand") {
    const test::MockRuntime mock;
    mock::Hand hand;
    hand.profile = "/interaction_profiles/htc/vive_controller";
    hand.grip.pose = somewhere;
    mock->set_hand(mock::Side::left, hand);
    const auto left = opened(xr::TrackedDevice::left_controller);
    (void)pose_of(*left);
    check_same(pose_of(*left), somewhere);
}

TEST_CASE("PoseTracker: the trigger of each kind of controller, and no press while it is switched off") {
    for (const char* profile :
         {"/interaction_profiles/khr/simple_controller", "/interaction_profiles/oculus/touch_controller",
          "/interaction_profiles/valve/index_controller", "/interaction_profiles/htc/vive_controller",
          "/interaction_profiles/microsoft/motion_controller"}) {
        CAPTURE(profile);
        const test::MockRuntime mock;
        mock::Hand hand;
        hand.profile = profile;
        mock->set_hand(mock::Side::right, hand);
        const auto right = opened(xr::TrackedDevice::right_controller);
        (void)pose_of(*right);
        (void)pose_of(*right);
        CHECK(!right->pressed());
        hand.trigger = 1.0F;
        mock->set_hand(mock::Side::right, hand);
        (void)pose_of(*right);
        CHECK(right->pressed());
        hand.active = false;
        mock->set_hand(mock::Side::right, hand);
        (void)pose_of(*right);
        CHECK(!right->pressed());
        CHECK(mock->take_violations().empty());
    }
}

TEST_CASE("PoseTracker: reports whether its poses are in the stage") {
    {
        const test::MockRuntime mock;
        CHECK(opened(xr::TrackedDevice::right_controller)->in_stage());
    }
    mock::Config config;
    config.spaces = {XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL};
    const test::MockRuntime mock(config);
    CHECK(!opened(xr::TrackedDevice::right_controller)->in_stage());
}

TEST_CASE("PoseTracker: counts how often the origin of its poses has moved") {
    const test::MockRuntime mock;
    mock->set_head({somewhere});
    const auto tracker = opened(xr::TrackedDevice::headset);
    (void)pose_of(*tracker);
    CHECK(tracker->origin_moves() == 0);
    mock->recentre(XR_REFERENCE_SPACE_TYPE_LOCAL, 0, std::nullopt);
    (void)pose_of(*tracker);
    CHECK(tracker->origin_moves() == 0);
    mock->recentre(XR_REFERENCE_SPACE_TYPE_STAGE, 0, Pose{{0.1, 0.0, 0.0}});
    (void)pose_of(*tracker);
    CHECK(tracker->origin_moves() == 1);
}

TEST_CASE("PoseTracker: a controller that is switched off, and a pose that is estimated, are not tracked") {
    const test::MockRuntime mock;
    mock::Hand hand;
    hand.active = false;
    mock->set_hand(mock::Side::right, hand);
    const auto right = opened(xr::TrackedDevice::right_controller);
    CHECK(!pose_of(*right).has_value());
    CHECK(!pose_of(*right).has_value());
    hand.active = true;
    hand.profile = "/interaction_profiles/khr/simple_controller";
    hand.grip.pose = somewhere;
    mock->set_hand(mock::Side::right, hand);
    (void)pose_of(*right);
    check_same(pose_of(*right), somewhere);
    hand.grip.tracked = false;
    mock->set_hand(mock::Side::right, hand);
    (void)pose_of(*right);
    CHECK(!pose_of(*right).has_value());
}

TEST_CASE("PoseTracker: without a runtime, a headset or the extension there is none, with the reason") {
    {
        const test::EnvironmentVariable none("XR_RUNTIME_JSON", "/nowhere.json");
        const auto tracker = xr::PoseTracker::open(xr::TrackedDevice::headset);
        REQUIRE(!tracker);
        CHECK(tracker.error().code == ErrorCode::no_device);
    }
    mock::Config config;
    config.connected = false;
    {
        const test::MockRuntime mock(config);
        const auto tracker = xr::PoseTracker::open(xr::TrackedDevice::headset);
        REQUIRE(!tracker);
        CHECK(tracker.error().code == ErrorCode::no_device);
    }
    config = {};
    config.extensions = {"XR_KHR_vulkan_enable2", "XR_KHR_convert_timespec_time"};
    const test::MockRuntime mock(config);
    const auto tracker = xr::PoseTracker::open(xr::TrackedDevice::headset);
    REQUIRE(!tracker);
    CHECK(tracker.error().message().find("lacks XR_MND_headless") != std::string::npos);
}

TEST_CASE("PoseTracker: a runtime that ends is a loss, and another tracker finds it again") {
    const test::MockRuntime mock;
    auto tracker = opened(xr::TrackedDevice::headset);
    (void)pose_of(*tracker);
    mock->send(mock::Event::instance_loss);
    const auto lost = tracker->read();
    REQUIRE(!lost);
    CHECK(lost.error().lost);
    tracker.reset();
    tracker = opened(xr::TrackedDevice::headset);
    mock->set_head({somewhere});
    check_same(pose_of(*tracker), somewhere);
}
