#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/replaced.hpp"
#include "tests/xr/support.hpp"

using namespace bolt;

namespace {

constexpr const char* hand_profile = "/interaction_profiles/ext/hand_interaction_ext";
constexpr const char* controllers[] = {
    "/interaction_profiles/khr/simple_controller",       "/interaction_profiles/oculus/touch_controller",
    "/interaction_profiles/valve/index_controller",      "/interaction_profiles/htc/vive_controller",
    "/interaction_profiles/microsoft/motion_controller",
};

xr::Hands hands_of(test::Program& program) {
    const std::optional<xr::HeadsetFrame> frame = program.frame();
    REQUIRE(frame.has_value());
    return frame->hands;
}

mock::Hand held(const std::string& profile) {
    mock::Hand hand;
    hand.profile = profile;
    hand.grip.pose = {{0.2, 1.0, -0.3}, rotation({0.1, 0.2, 0.3})};
    hand.aim.pose = {{0.2, 1.05, -0.4}, rotation({-0.3, 0.0, 0.0})};
    hand.trigger = 0.75F;
    hand.squeeze = 0.25F;
    hand.stick = {0.5F, -0.5F};
    return hand;
}

void check_same(const std::optional<xr::ReportedPose>& pose, const Pose& expected) {
    REQUIRE(pose.has_value());
    CHECK(glm::length(pose->pose.position - expected.position) < 1e-6);
    CHECK(glm::length(turn_between(pose->pose.orientation, expected.orientation)) < 1e-5);
}

bool has_line(const std::vector<std::string>& lines, const std::string& line) {
    return std::find(lines.begin(), lines.end(), line) != lines.end();
}

}  // namespace

TEST_CASE("Hands: the bindings of every controller are accepted") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.headset().input().profiles() ==
          std::vector<std::string>(std::begin(controllers), std::end(controllers)));
    const std::vector<std::string> bindings = mock->accepted_bindings();
    for (const char* controller : controllers)
        for (const std::string side : {"left", "right"})
            for (const char* end : {"grip#input/grip/pose", "aim#input/aim/pose", "vibrate#output/haptic"}) {
                const std::string line =
                    std::string(controller) + " " + test::replaced(end, "#", " /user/hand/" + side + "/");
                CHECK_MESSAGE(has_line(bindings, line), line);
            }
    const std::string touch = "/interaction_profiles/oculus/touch_controller ";
    CHECK(has_line(bindings, touch + "menu /user/hand/left/input/menu/click"));
    CHECK(has_line(bindings, touch + "menu /user/hand/right/input/b/click"));
    CHECK(has_line(bindings, touch + "secondary /user/hand/left/input/x/click"));
    CHECK(has_line(bindings, touch + "secondary /user/hand/right/input/a/click"));
}

TEST_CASE("Hands: a controller that the runtime does not know is left out") {
    for (const char* controller : controllers) {
        mock::Config config;
        config.unknown_profiles = {controller};
        const test::MockRuntime mock(config);
        test::Program program;
        REQUIRE(program.connect());
        const std::vector<std::string>& profiles = program.headset().input().profiles();
        CHECK(profiles.size() == std::size(controllers) - 1);
        CHECK_FALSE(has_line(profiles, controller));
    }
}

TEST_CASE("Hands: pinch and grasp are bound if the runtime has them") {
    mock::Config config;
    config.extensions.emplace_back("XR_EXT_hand_interaction");
    const test::MockRuntime mock(config);
    test::Program program;
    REQUIRE(program.connect());
    CHECK(program.headset().input().profiles().back() == hand_profile);
    CHECK(has_line(mock->accepted_bindings(),
                   std::string(hand_profile) + " select /user/hand/left/input/pinch_ext/value"));
    mock->set_hand(mock::Side::right, held(hand_profile));
    (void)program.focus();
    const xr::HandInput hand = hands_of(program)[xr::Side::right];
    CHECK(hand.select == 0.75F);
    CHECK(hand.grasp == 0.25F);
}

TEST_CASE("Hands: the values of every controller arrive, those of each hand by themselves") {
    for (const std::string controller : controllers) {
        CAPTURE(controller);
        const bool simple = controller.find("simple") != std::string::npos;
        const bool clicks =
            controller.find("vive") != std::string::npos || controller.find("microsoft") != std::string::npos;
        const test::MockRuntime mock;
        test::Program program;
        REQUIRE(program.connect());
        const mock::Hand right = held(controller);
        mock::Hand left = held(controller);
        left.trigger = left.squeeze = 0.0F;
        left.stick = {};
        left.menu = left.secondary = true;
        mock->set_hand(mock::Side::left, left);
        mock->set_hand(mock::Side::right, right);
        (void)program.focus();
        const xr::Hands hands = hands_of(program);
        const xr::HandInput &r = hands[xr::Side::right], &l = hands[xr::Side::left];
        CHECK(r.active);
        check_same(r.grip, right.grip.pose);
        check_same(r.aim, right.aim.pose);
        CHECK(r.grip->tracked);
        CHECK(r.select == (simple ? 1.0F : 0.75F));
        CHECK(r.grasp == (simple ? 1.0F : clicks ? 0.0F : 0.25F));
        CHECK(r.stick == (simple ? glm::vec2(0.0F) : glm::vec2(0.5F, -0.5F)));
        CHECK_FALSE(r.menu);
        CHECK_FALSE(r.secondary);
        CHECK(l.select == 0.0F);
        CHECK(l.stick == glm::vec2(0.0F));
        CHECK(l.menu);
        CHECK(l.secondary == !simple);
        CHECK_FALSE(l.joints.has_value());
        const Result<std::string> profile = program.headset().input().profile(xr::Side::right);
        REQUIRE(profile.has_value());
        CHECK(*profile == controller);
    }
}

TEST_CASE("Hands: without focus, and without a controller, none is active") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    mock::Hand pressed = held(controllers[1]);
    pressed.menu = true;
    mock->set_hand(mock::Side::left, pressed);
    mock::Hand absent = pressed;
    absent.active = false;
    mock->set_hand(mock::Side::right, absent);
    (void)program.focus();
    xr::Hands hands = hands_of(program);
    CHECK(hands[xr::Side::left].active);
    CHECK(hands[xr::Side::left].menu);
    CHECK_FALSE(hands[xr::Side::right].active);
    CHECK_FALSE(hands[xr::Side::right].grip.has_value());
    CHECK_FALSE(hands[xr::Side::right].menu);
    CHECK(program.headset().input().profile(xr::Side::right)->empty());
    mock->send(mock::Event::focus_lost);
    hands = hands_of(program);
    for (const xr::HandInput& hand : hands.sides) {
        CHECK_FALSE(hand.active);
        CHECK_FALSE(hand.grip.has_value());
        CHECK(hand.select == 0.0F);
        CHECK_FALSE(hand.menu);
    }
}

TEST_CASE("Hands: an estimated pose is marked, an invalid one is left out") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock::Hand hand = held(controllers[1]);
    hand.grip.tracked = false;
    hand.aim.valid = false;
    mock->set_hand(mock::Side::left, hand);
    const xr::HandInput left = hands_of(program)[xr::Side::left];
    CHECK(left.active);
    check_same(left.grip, hand.grip.pose);
    CHECK_FALSE(left.grip->tracked);
    CHECK_FALSE(left.aim.has_value());
    CHECK(left.select == 0.75F);
}

TEST_CASE("Hands: joints are valid one by one") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    mock::Hand hand;
    hand.active = false;
    hand.has_joints = true;
    for (std::size_t i = 0; i < mock::joint_count; ++i) {
        hand.joints[i].at.pose = {{0.01 * static_cast<double>(i), 1.0, 0.0}};
        hand.joints[i].radius = 0.005F;
        hand.joints[i].at.valid = i % 3 != 0;
        hand.joints[i].at.tracked = i % 2 != 0;
    }
    mock->set_hand(mock::Side::left, hand);
    const xr::HandInput left = hands_of(program)[xr::Side::left];
    CHECK(left.active);
    CHECK_FALSE(left.grip.has_value());
    REQUIRE(left.joints.has_value());
    for (std::size_t i = 0; i < xr::hand_joint_count; ++i) {
        const xr::HandJoint& joint = (*left.joints)[i];
        CHECK(joint.valid == (i % 3 != 0));
        CHECK(finite(joint.pose.position));
        if (!joint.valid) continue;
        CHECK(joint.pose.position.x == doctest::Approx(0.01 * static_cast<double>(i)));
        CHECK(joint.radius == doctest::Approx(0.005));
    }
    // A hand that is active without one valid joint is as good as none.
    for (mock::Joint& joint : hand.joints) joint.at.valid = false;
    mock->set_hand(mock::Side::left, hand);
    const xr::HandInput none = hands_of(program)[xr::Side::left];
    CHECK_FALSE(none.joints.has_value());
    CHECK_FALSE(none.active);
}

TEST_CASE("Hands: joints alone give a ray away from the shoulder, and a pinch") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    mock->set_head({{{0.1, 1.6, 0.2}, rotation({-0.3, 0.0, 0.0})}});
    const auto show = [&](double distance, bool tip_valid) {
        mock::Hand hand;
        hand.active = false;
        hand.has_joints = true;
        for (mock::Joint& joint : hand.joints) joint.at.pose.position = {0.3, 1.3, -0.2};
        hand.joints[5].at.pose.position = {0.3, 1.3 - distance, -0.3};
        hand.joints[10].at.pose.position = {0.3, 1.3, -0.3};
        hand.joints[10].at.valid = tip_valid;
        mock->set_hand(mock::Side::right, hand);
        return hands_of(program)[xr::Side::right];
    };
    const auto pinches = [&](double distance, bool tip_valid = true) {
        return show(distance, tip_valid).select > 0.5F;
    };
    for (int i = 0; i < 5; ++i) (void)show(0.08, true);  // until the session has the focus
    const xr::HandInput open = show(0.08, true);
    REQUIRE(open.active);
    REQUIRE(open.aim);
    CHECK(glm::distance(open.aim->pose.position, Vec3(0.3, 1.3, -0.2)) < 1e-6);
    // The right shoulder is beside and below the head; the ray goes on in a straight line from there.
    const Vec3 along = open.aim->pose.orientation * Vec3(0.0, 0.0, -1.0);
    const Vec3 shoulder = open.aim->pose.position - 0.5 * along;
    CHECK(glm::distance(shoulder, Vec3(0.28, 1.35, 0.28)) < 0.06);
    CHECK(std::abs((open.aim->pose.orientation * Vec3(1.0, 0.0, 0.0)).y) < 1e-9);  // not tilted
    CHECK_FALSE(pinches(0.03));
    CHECK(pinches(0.018));
    CHECK(pinches(0.03));         // hysteresis
    CHECK(pinches(0.08, false));  // a hidden tip ends nothing
    CHECK_FALSE(pinches(0.05));
    CHECK_FALSE(pinches(0.03));
    CHECK_FALSE(pinches(0.01, false));  // and begins nothing
}

TEST_CASE("Hands: a headset that tracks no hands still has controllers") {
    for (const bool offered : {false, true}) {
        mock::Config config;
        config.tracks_hands = false;
        if (!offered) config.extensions.pop_back();
        const test::MockRuntime mock(config);
        test::Program program;
        mock::Hand hand = held(controllers[1]);
        hand.has_joints = true;
        mock->set_hand(mock::Side::left, hand);
        REQUIRE(program.connect());
        (void)program.focus();
        const xr::HandInput left = hands_of(program)[xr::Side::left];
        CHECK(left.active);
        CHECK_FALSE(left.joints.has_value());
        CHECK(mock->calls("xrCreateHandTrackerEXT") == 0);
    }
    // One that announces hands and then cannot track them does too.
    const test::MockRuntime mock;
    mock->fail_next("xrCreateHandTrackerEXT", XR_ERROR_FEATURE_UNSUPPORTED, 2);
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    CHECK(hands_of(program)[xr::Side::left].active);
}

TEST_CASE("Vibration: is clamped to what runtimes accept, and stops") {
    const test::MockRuntime mock;
    test::Program program;
    REQUIRE(program.connect());
    (void)program.focus();
    xr::Headset& headset = program.headset();
    headset.vibrate(xr::Side::right, {3.0F, 160.0F, 0.05});
    headset.vibrate(xr::Side::left, {0.5F, 0.0F, 0.0});
    headset.vibrate(xr::Side::left, {-1.0F, 0.0F, 0.0});
    headset.vibrate(xr::Side::right, {std::nanf(""), 0.0F, 0.1});
    const std::vector<mock::Vibration> vibrations = mock->take_vibrations();
    REQUIRE(vibrations.size() == 4);
    CHECK(vibrations[0].side == mock::Side::right);
    CHECK(vibrations[0].amplitude == 1.0F);
    CHECK(vibrations[0].frequency == 160.0F);
    CHECK(vibrations[0].duration == 50'000'000);
    CHECK(vibrations[1].side == mock::Side::left);
    CHECK(vibrations[1].amplitude == 0.5F);
    CHECK(vibrations[1].frequency == XR_FREQUENCY_UNSPECIFIED);
    CHECK(vibrations[1].duration == XR_MIN_HAPTIC_DURATION);
    CHECK(vibrations[2].stop);
    CHECK(vibrations[3].stop);
    CHECK(headset.connected());
    mock->send(mock::Event::focus_lost);
    (void)program.frame();
    headset.vibrate(xr::Side::right, {1.0F, 0.0F, 0.1});
    CHECK(mock->take_vibrations().empty());
}

TEST_CASE("Hands: names that are long or foreign are accepted") {
    const test::MockRuntime mock;
    xr::HeadsetOptions options;
    std::string longest;
    for (int i = 0; i < 100; ++i) longest += "拧";  // three bytes; 128 bytes fit, with the end
    options.names.grip = longest;
    test::Program program(options);
    REQUIRE(program.connect());
    CHECK(program.focus().focused);
}
