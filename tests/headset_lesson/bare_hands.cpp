// A trainee without controllers in the mock headset: starts a lesson by a pinch, pauses it, and plays it.
#include <glm/mat3x3.hpp>

#include "tests/headset_lesson/headset_driver.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"

using namespace bolt;

namespace {

using ShowHand = std::function<mock::Hand(const xr::HandInput& hand, xr::Side side)>;

// A hand of which the runtime knows only the joints. Its palm is at the grip pose (OpenXR: the fingers along
// −Y, the thumb at −Z, X out of a left palm and into a right one). Closing brings the tips of thumb and index
// together.
mock::Hand joints_only(const xr::HandInput& hand, xr::Side side) {
    mock::Hand shown;
    shown.active = false;
    shown.has_joints = hand.active && hand.grip.has_value();
    if (!shown.has_joints) return shown;
    const double right = side == xr::Side::right ? 1.0 : -1.0;
    const glm::dmat3 palm_in_grip(Vec3(0.0, 0.0, right), Vec3(right, 0.0, 0.0), Vec3(0.0, 1.0, 0.0));
    const Pose palm = hand.grip->pose * Pose{Vec3(0.0), glm::quat_cast(palm_in_grip)};
    const auto closed = static_cast<double>(std::max(hand.grasp, hand.select));
    for (std::size_t i = 0; i < mock::joint_count; ++i) {
        Vec3 at(0.0);  // x to the right, y out of the back, −z along the fingers
        if (i >= 6) at = {-0.03 + 0.02 * static_cast<double>((i - 6) / 5), 0.0, 0.01};
        if (i == 10) at = {-0.03, -0.03, -0.055};
        if (i == 5) at = {-0.03, -0.03 - (0.08 - 0.065 * closed), -0.055};
        at.x *= right;
        shown.joints[i].at = {palm * Pose{at}, true, true};
    }
    return shown;
}

// A hand with XR_EXT_hand_interaction.
mock::Hand interacting(const xr::HandInput& hand, xr::Side) {
    mock::Hand shown;
    shown.active = hand.active && hand.grip.has_value();
    shown.profile = "/interaction_profiles/ext/hand_interaction_ext";
    shown.trigger = hand.select;
    shown.squeeze = hand.grasp;
    if (hand.grip) shown.grip.pose = shown.aim.pose = hand.grip->pose;
    return shown;
}

class PointingUser {
  public:
    PointingUser(test::HeadsetDriver& driver, const Pose& head) : driver_(driver), head_(head) {}

    // Presses the widget: moves the hand until the pointer is on it, then pinches.
    void press(words::TextKey label) {
        glm::dvec2 goal(0.0);
        bool found = false;
        for (int i = 0; i < 4; ++i) {
            frame(0.0F);
            for (const trainer::DrawnWidget& widget : driver_.app().drawn_widgets()) {
                if (widget.label != label) continue;
                goal = widget.middle;
                found = true;
            }
        }
        REQUIRE(found);
        double error = 1e9;
        for (int i = 0; i < 200 && error > 4.0; ++i) {
            const trainer::PanelPointer& pointer = driver_.app().room()->pointer;
            REQUIRE(pointer.on_panel);
            const glm::dvec2 off = goal - pointer.at;
            error = glm::length(off);
            const double m = trainer::point_size / static_cast<double>(trainer::panel_scale);
            hand_.position += 0.3 * m * Vec3(off.x, -off.y, 0.0);
            frame(0.0F);
        }
        REQUIRE(error <= 4.0);
        for (const float pinch : {1.0F, 1.0F, 1.0F, 0.0F, 0.0F, 0.0F}) frame(pinch);
    }

    void frame(float pinch) {
        xr::Hands hands;
        xr::HandInput& right = hands[xr::Side::right];
        right.active = true;
        right.select = pinch;
        right.grip = xr::ReportedPose{hand_, true};
        driver_.frame(head_, hands);
    }

  private:
    test::HeadsetDriver& driver_;
    Pose head_;
    Pose hand_{{0.12, 1.45, -0.35}, {1.0, 0.0, 0.0, 0.0}};
};

void play_by_pinches(const std::string& name, const ShowHand& show, bool hand_interaction) {
    mock::Config config;
    if (hand_interaction) config.extensions.emplace_back("XR_EXT_hand_interaction");
    const test::MockRuntime mock(config);
    trainer::AppOptions options = test::headset_lesson_options("first-nut", BOLT_TRAINER_OUT);
    options.menu = true;
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / name;
    test::Program program(std::move(options), platform::Size{160, 120});
    test::HeadsetDriverOptions how;
    const auto send = [&](const Pose& head, const xr::Hands& hands) {
        mock->set_head({head});
        mock->set_hand(mock::Side::left, show(hands[xr::Side::left], xr::Side::left));
        mock->set_hand(mock::Side::right, show(hands[xr::Side::right], xr::Side::right));
        return Status();
    };
    test::HeadsetDriver driver(*program.app, send, how);
    const Pose head{{0.0, 1.65, 0.0}, {1.0, 0.0, 0.0, 0.0}};
    std::vector<std::string> log;
    const Status run = test::play_in_headset(program, driver, log, [&] {
        const trainer::App& app = driver.app();
        PointingUser user(driver, head);
        user.press("menu.start");
        for (int i = 0; i < 50 && app.screen() != trainer::ShownScreen::lesson; ++i) user.frame(0.0F);
        REQUIRE(app.screen() == trainer::ShownScreen::lesson);
        user.press("room.pause");
        CHECK(app.lesson()->clock.paused);
        user.press("menu.go_on");
        CHECK_FALSE(app.lesson()->clock.paused);
        user.press("room.raise");
        CHECK(app.room()->height == doctest::Approx(trainer::raise_step));
        user.press("room.turn_left");
        CHECK(app.room()->turns == -1);
        user.press("room.turn_right");
        CHECK(app.room()->turns == 0);
        driver.set_draw_interval(2.0);
        test::TraineeInRoom trainee(driver);
        trainee.play(120.0);
        CHECK(app.screen() == trainer::ShownScreen::result);
    });
    for (const std::string& line : log) MESSAGE(line);
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
    REQUIRE(program.played);
    CHECK(program.played->result.finished);
    for (const lesson::JointResult& joint : program.played->result.joints)
        CHECK(joint.overall == lesson::Verdict::ok);
    MESSAGE("score " << program.played->result.score);
}

}  // namespace

TEST_CASE("Bare hands: known by their joints alone, they start a lesson by a pinch, pause it and play it") {
    play_by_pinches("joints", joints_only, false);
}

TEST_CASE("Bare hands: with XR_EXT_hand_interaction they start a lesson by a pinch, pause it and play it") {
    play_by_pinches("interaction", interacting, true);
}
