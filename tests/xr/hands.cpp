// Controllers and tracked hands on the mock runtime, and the mock's own checks.
#include "tests/xr/headset_case.hpp"

using namespace bolt;
using test::control;
using test::HeadsetCase;
namespace mock = bolt::mock_openxr;

namespace {

mock::Hand holding_hand() {
    mock::Hand hand;
    hand.active = true;
    hand.grip = {{0.2, 1.1, -0.3}, rotation(Vec3(0.3, -0.2, 0.1))};
    hand.aim = {{0.2, 1.1, -0.35}, rotation(Vec3(-0.4, 0.1, 0.0))};
    hand.trigger = 0.25F;
    hand.squeeze = 0.75F;
    hand.stick_x = -0.5F;
    hand.stick_y = 0.5F;
    hand.menu = hand.secondary = true;
    return hand;
}

}  // namespace

TEST_CASE("Hands: every common controller gives pose, trigger, squeeze and buttons") {
    for (const char* profile :
         {"/interaction_profiles/khr/simple_controller", "/interaction_profiles/oculus/touch_controller",
          "/interaction_profiles/valve/index_controller", "/interaction_profiles/htc/vive_controller"}) {
        CAPTURE(profile);
        mock::Config config;
        config.profile = profile;
        HeadsetCase c(config);
        REQUIRE(c.connect());
        REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
        CHECK(c.headset->input().profiles().size() == 5);  // the mock does not know Microsoft's
        for (const int side : {0, 1}) control().set_hand(side, holding_hand());
        (void)c.frame();
        REQUIRE(c.frame());
        const bool simple = std::string(profile).find("simple") != std::string::npos;
        const bool vive = std::string(profile).find("vive") != std::string::npos;
        for (const xr::Side side : {xr::Side::left, xr::Side::right}) {
            const xr::HandInput& hand = c.last.hands[side];
            REQUIRE(hand.active);
            CHECK(hand.grip->tracked);
            CHECK(glm::distance(hand.grip->pose.position, Vec3(0.2, 1.1, -0.3)) < 1e-6);
            CHECK(glm::distance(hand.aim->pose.position, Vec3(0.2, 1.1, -0.35)) < 1e-6);
            CHECK(hand.grasp == (simple || vive ? 1.0F : 0.75F));  // a button gives 0 or 1
            CHECK(hand.select == (simple ? 1.0F : 0.25F));
            CHECK(hand.stick == (simple ? glm::vec2(0.0F) : glm::vec2(-0.5F, 0.5F)));
            CHECK(hand.menu);
            CHECK(hand.secondary == !simple);
        }
        CHECK(test::need(c.headset->input().profile(xr::Side::right)) == profile);
    }
}

TEST_CASE("Hands: without focus nothing is active; a lost pose is absent, an estimated one is marked") {
    HeadsetCase c;
    REQUIRE(c.connect());
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    mock::Hand hand = holding_hand();
    hand.tracked = false;
    control().set_hand(1, hand);
    (void)c.frame();
    REQUIRE(c.frame());
    CHECK_FALSE(c.last.hands[xr::Side::left].active);
    CHECK_FALSE(c.last.hands[xr::Side::right].grip->tracked);
    hand.valid = false;
    control().set_hand(1, hand);
    REQUIRE(c.frame());
    CHECK(c.last.hands[xr::Side::right].active);
    CHECK_FALSE(c.last.hands[xr::Side::right].grip);
    control().send(mock::Event::lose_focus);
    (void)c.frame();
    REQUIRE(c.frame());
    CHECK_FALSE(c.last.hands[xr::Side::right].active);
}

TEST_CASE("Hands: joints of a tracked hand are used one by one, because single ones may be invalid") {
    HeadsetCase c;
    REQUIRE(c.connect());
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    mock::Hand hand = holding_hand();
    hand.active = false;
    hand.joints = true;
    control().set_hand(0, hand);
    (void)c.frame();
    REQUIRE(c.frame());
    CHECK_FALSE(c.last.hands[xr::Side::left].joints);  // no joint is valid
    hand.joint_valid[0] = hand.joint_valid[10] = true;
    control().set_hand(0, hand);
    REQUIRE(c.frame());
    REQUIRE(c.last.hands[xr::Side::left].joints);
    const xr::HandJoints& joints = *c.last.hands[xr::Side::left].joints;
    CHECK(joints[0].valid);
    CHECK_FALSE(joints[1].valid);
    CHECK(joints[10].radius == doctest::Approx(0.01));
}

TEST_CASE("Hands: a vibration is limited to the controller's range, and stops at zero") {
    HeadsetCase c;
    REQUIRE(c.connect());
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    c.headset->vibrate(xr::Side::right, {1.5F, 120.0F, 0.02});
    c.headset->vibrate(xr::Side::left, {0.0F, 0.0F, 0.0});
    const std::vector<mock::VibrationRecord> made = control().vibrations();
    REQUIRE(made.size() == 2);
    CHECK(made[0].side == 1);
    CHECK(made[0].amplitude == 1.0F);
    CHECK(made[0].frequency == 120.0F);
    CHECK(made[1].side == 0);
    CHECK(made[1].amplitude == 0.0F);
    control().send(mock::Event::lose_focus);
    (void)c.frame();
    c.headset->vibrate(xr::Side::right, {0.5F, 0.0F, 0.0});
    CHECK(control().vibrations().size() == 2);
}

TEST_CASE("Mock runtime: it reports calls in the wrong order") {
    HeadsetCase c;
    c.expects_violations = true;
    REQUIRE(c.connect());
    REQUIRE(c.reach(XR_SESSION_STATE_FOCUSED));
    (void)control().violations();
    const XrSession session = c.headset->session().get();
    const auto reported = [&](const char* what) {
        for (const std::string& violation : control().violations())
            if (violation.find(what) != std::string::npos) return true;
        return false;
    };
    const XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO,           nullptr, 1,
                             XR_ENVIRONMENT_BLEND_MODE_OPAQUE, 0,       nullptr};
    CHECK(xrEndFrame(session, &end) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(reported("xrEndFrame without xrBeginFrame"));
    CHECK(xrEndSession(session) == XR_ERROR_SESSION_NOT_STOPPING);
    CHECK(reported("xrEndSession in another state"));
    const XrSessionBeginInfo begin{XR_TYPE_SESSION_BEGIN_INFO, nullptr,
                                   XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO};
    CHECK(xrBeginSession(session, &begin) == XR_ERROR_SESSION_RUNNING);
    CHECK(xrAttachSessionActionSets(session, nullptr) == XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
    std::optional<xr::HeadsetFrame> frame = c.headset->begin_frame(1.0);
    REQUIRE(frame);
    frame->timing.display_time += 1;
    c.headset->end_frame(*frame, false, {});
    CHECK(reported("another time"));
}
