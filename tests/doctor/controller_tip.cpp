// Touching points with a controller and an arm, in virtual time.
#include "game/station/controller_tip.hpp"

#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "game/station/frame_registration.hpp"

namespace controller_tip_test {

using namespace bolt;
using namespace bolt::station_setup;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const Vec3 controller_end{0.01, -0.02, -0.08}, arm_end{0.0, 0.0, 0.12};

// The pose that puts the end of a tool, given in its own frame, on a point.
Pose pose_on(const Vec3& point, const Quat& orientation, const Vec3& end) {
    return {point - orientation * end, orientation};
}

// A user who touches each requested point half a second later, with the tool of the request, and presses its
// button for 50 ms. Each tool sends a sample a millisecond.
struct ScriptedUser {
    Pose arm_in_room;
    std::vector<Vec3> points;  // in the frame of the arm
    double noise = 0.0;        // m, standard deviation on each axis of each position of the controller
    double touch_error = 0.0;  // m, the same of each touch with the controller
    Random random{5};
    device::VirtualTime time;
    double requested = 1e9;  // s
    bool with_arm = false;
    std::size_t point = 0;  // of the last request
    Pose held;              // of the tool that the last request names
    std::string shown;

    TouchIo arm() {
        return {[this] { return arm_sample(); }, [] { return false; }, [] { return false; },
                [this](std::string_view line) { follow(line); }, device::virtual_timer(time)};
    }
    ControllerIo controller() {
        return {[this]() -> Result<ControllerSample> { return controller_sample(); }, [] { return false; },
                [] { return false; }, [this](std::string_view line) { follow(line); },
                device::virtual_timer(time)};
    }

  private:
    [[nodiscard]] bool presses() const { return time.now > requested + 0.5 && time.now < requested + 0.55; }
    Vec3 random_error(double deviation) {
        return deviation * Vec3(random.normal(), random.normal(), random.normal());
    }
    void follow(std::string_view line) {
        (shown += line) += '\n';
        if (line.find(": touch") == std::string_view::npos) return;
        requested = time.now;
        with_arm = has(std::string(line), "tip of the arm");
        point = static_cast<std::size_t>(line[6] - '1');
        const Quat orientation = random_turn(random);
        held = with_arm ? pose_on(points[point], orientation, arm_end)
                        : pose_on(arm_in_room * points[point] + random_error(touch_error), orientation,
                                  controller_end);
    }
    device::DeviceSnapshot arm_sample() const {
        device::DeviceSnapshot snapshot;
        snapshot.usable = true;
        snapshot.number = static_cast<std::uint64_t>(time.now * 1000.0) + 1;
        if (with_arm) snapshot.sample.pose = held;
        snapshot.sample.buttons = with_arm && presses() ? 1 : 0;
        return snapshot;
    }
    ControllerSample controller_sample() {
        if (with_arm) return {Pose{}, false};
        return {Pose{held.position + random_error(noise), held.orientation}, presses()};
    }
};

// Around a place of work, not in a plane; the last is near the middle.
std::vector<Vec3> chosen_points() {
    return {{-0.1, -0.08, -0.1}, {0.12, -0.1, -0.08}, {0.11, 0.1, -0.1}, {-0.1, 0.09, 0.1},
            {0.1, 0.02, 0.12},   {-0.08, -0.1, 0.1},  {0.02, 0.03, 0.01}};
}

const Pose arm_place{{0.4, 0.9, -0.6}, rotation({0.1, 2.0, -0.2})};

Result<MeasuredRegistration> registered(ScriptedUser& user) {
    user.arm_in_room = arm_place;
    user.points = chosen_points();
    ArmTip arm(user.arm(), arm_end);
    ControllerTip controller(user.controller(), controller_end);
    BOLT_TRY_ASSIGN(const std::vector<PointPair> pairs, measure_pairs(arm, controller, user.points.size()));
    return register_frames(content::CoordinateFrame::arm, content::CoordinateFrame::room, pairs,
                           "2026-03-02T09:15:00Z");
}

// A controller whose samples a function of the time gives.
struct ScriptedController {
    device::VirtualTime time;
    std::function<Result<ControllerSample>(double now)> at;
    std::vector<double> enter;  // s, times at which Enter is pressed
    double stop_at = 1e9;
    std::string shown;

    ControllerIo io() {
        return {[this] { return at(time.now); },
                [this] {
                    if (enter.empty() || time.now < enter.front()) return false;
                    enter.erase(enter.begin());
                    return true;
                },
                [this] { return time.now >= stop_at; },
                [this](std::string_view line) { (shown += line) += '\n'; }, device::virtual_timer(time)};
    }
};

const Pose somewhere{{0.3, 1.2, -0.4}, rotation({0.0, 0.0, pi / 2})};

}  // namespace

TEST_CASE("Controller tip: exact touches with both tools give the pose of the arm") {
    ScriptedUser user;
    const auto measured = registered(user);
    REQUIRE_MESSAGE(measured, (measured ? "" : measured.error().message()));
    const Pose& pose = measured->registration.pose;
    CHECK(glm::length(pose.position - arm_place.position) < 1e-12);
    CHECK(glm::length(turn_between(pose.orientation, arm_place.orientation)) < 1e-12);
    CHECK(measured->check_error < 1e-12);
    CHECK(has(user.shown, "Point 7 of 7: touch the same point with the tip of the arm"));
    CHECK(!has(user.shown, "Once more"));
}

TEST_CASE("Controller tip: noise of 0.5 mm of each pose changes the registration by less than 0.3 mm") {
    ScriptedUser user;
    user.noise = 0.5e-3;
    const auto measured = registered(user);
    REQUIRE_MESSAGE(measured, (measured ? "" : measured.error().message()));
    for (const Vec3& point : chosen_points())
        CHECK(glm::length(measured->registration.pose * point - arm_place * point) < 0.3e-3);
}

TEST_CASE("Controller tip: touches that are off by 1 mm on each axis are good enough for training") {
    double sum = 0.0;
    constexpr int repeats = 50;
    for (int i = 0; i < repeats; ++i) {
        ScriptedUser user;
        user.random = Random(100 + static_cast<std::uint64_t>(i));
        user.touch_error = 1e-3;
        user.noise = 0.3e-3;
        const auto measured = registered(user);
        REQUIRE_MESSAGE(measured, (measured ? "" : measured.error().message()));
        CHECK(check_quality(*measured));
        const double error = glm::length(measured->registration.pose.position - arm_place.position);
        CHECK(error < 3e-3);
        sum += error * error / repeats;
    }
    // The table of docs/station.md has 1.4 mm for six points with 2 mm of noise.
    CHECK(std::sqrt(sum) < 0.9e-3);
    CHECK(std::sqrt(sum) > 0.4e-3);
}

TEST_CASE("Controller tip: a button that is still held is no press, and an Enter from before is none") {
    ScriptedController hand;
    hand.at = [](double now) { return ControllerSample{somewhere, now < 0.5 || now > 1.0}; };
    hand.enter = {0.0};
    const auto measured = ControllerTip(hand.io(), {0.1, 0.0, 0.0}).touch(0, "Touch.");
    REQUIRE(measured);
    CHECK(glm::length(*measured - Vec3(0.3, 1.3, -0.4)) < 1e-12);
    CHECK(hand.time.now == doctest::Approx(1.0 + controller_touch.duration).epsilon(0.02));
    ScriptedController by_key;
    by_key.at = [](double) { return ControllerSample{somewhere, true}; };
    by_key.enter = {0.7};
    CHECK(ControllerTip(by_key.io(), {}).touch(0, "Touch."));
    CHECK(by_key.time.now == doctest::Approx(0.7 + controller_touch.duration).epsilon(0.02));
}

TEST_CASE("Controller tip: while it is not tracked the user is told so once, and no press measures") {
    ScriptedController hand;
    hand.at = [](double now) {
        const std::optional<Pose> pose = now > 3.0 ? std::optional(somewhere) : std::nullopt;
        return ControllerSample{pose, now > 4.0};
    };
    const auto measured = ControllerTip(hand.io(), {}).touch(0, "Touch.");
    REQUIRE(measured);
    CHECK(hand.time.now > 4.0);
    const std::string message = "The controller is not tracked";
    CHECK(has(hand.shown, message));
    CHECK(hand.shown.find(message) == hand.shown.rfind(message));
    CHECK(has(hand.shown, "The controller is tracked again."));

    ScriptedController pressed;
    pressed.at = hand.at;
    pressed.enter = {0.1, 2.0};
    REQUIRE(ControllerTip(pressed.io(), {}).touch(0, "Touch."));
    CHECK(pressed.time.now > 4.0);
    CHECK(pressed.shown.find(message) != pressed.shown.rfind(message));
}

TEST_CASE("Controller tip: points on both sides of a recentring are not mixed") {
    ScriptedController hand;
    std::uint32_t moves = 2;  // earlier ones do no harm
    hand.at = [&](double now) { return ControllerSample{somewhere, std::fmod(now, 2.0) > 1.0, moves}; };
    ControllerTip tip(hand.io(), {});
    REQUIRE(tip.touch(0, "Touch."));
    REQUIRE(tip.touch(1, "Touch."));
    moves = 3;
    const auto third = tip.touch(2, "Touch.");
    REQUIRE(!third);
    CHECK(has(third.error().message(), "recentred"));
}

TEST_CASE("Controller tip: a hand that moves, and a controller that is hidden meanwhile, touch once more") {
    ScriptedController hand;
    hand.at = [](double now) {
        ControllerSample sample{somewhere, std::fmod(now, 2.0) > 1.0};
        if (now < 2.0) sample.pose->position.x += 0.05 * now;
        if (now > 3.1 && now < 3.15) sample.pose.reset();
        return sample;
    };
    const auto measured = ControllerTip(hand.io(), {}).touch(2, "Touch.");
    REQUIRE(measured);
    CHECK(glm::length(*measured - somewhere.position) < 1e-12);
    CHECK(hand.time.now == doctest::Approx(5.0 + controller_touch.duration).epsilon(0.02));
    CHECK(has(hand.shown, "Point 3: the hand moved by 7."));
    CHECK(has(hand.shown, "Point 3: the controller was not tracked all the time. Once more."));
}

TEST_CASE("Controller tip: a tracker that is lost, and a user who ends it, end the wait") {
    ScriptedController lost;
    lost.at = [](double now) -> Result<ControllerSample> {
        if (now > 0.5) return fail(ErrorCode::no_device, "the runtime has ended", "a runtime");
        return ControllerSample{};
    };
    const auto none = ControllerTip(lost.io(), {}).touch(0, "Touch.");
    REQUIRE(!none);
    CHECK(none.error().code == ErrorCode::no_device);
    ScriptedController ended;
    ended.at = [](double) { return ControllerSample{}; };
    ended.stop_at = 0.3;
    CHECK(ControllerTip(ended.io(), {}).touch(0, "Touch.").error().message() ==
          "the registration was interrupted");
}

TEST_CASE("Controller tip: it is found by turning the controller about it, and touches with it are right") {
    const Vec3 point(0.2, 0.8, -0.3);
    ScriptedController hand;
    // The first time the user turns about one axis, the second time the tip slips by 2 cm.
    hand.at = [&](double now) {
        const bool one_axis = now<8.0, slips = now> 12.0 && now < 16.0;
        const Quat turn =
            rotation({0.6 * std::sin(3.0 * now), one_axis ? 0.0 : 0.6 * std::cos(2.0 * now), 0.0});
        const Vec3 on = point + Vec3(slips ? 0.02 : 0.0, 0.0, 0.0);
        return ControllerSample{pose_on(on, turn, controller_end), std::fmod(now, 8.0) > 1.0};
    };
    ControllerTip tip(hand.io(), {});
    const auto fit = tip.find_tip();
    REQUIRE(fit);
    CHECK(glm::length(fit->tip - controller_end) < 1e-12);
    CHECK(glm::length(fit->pivot - point) < 1e-12);
    CHECK(hand.time.now == doctest::Approx(17.0 + pivot_time).epsilon(0.01));
    CHECK(has(hand.shown, "the tool was turned too little, or about one axis only; expected"));
    CHECK(has(hand.shown, "The tip has slipped"));
    CHECK(has(hand.shown, "The tip is at 0.0100,-0.0200,-0.0800 m in the frame of the grip; rms 0.0 mm."));
    const auto touched = tip.touch(0, "Touch.");
    REQUIRE(touched);
    CHECK(glm::length(*touched - point) < 1e-12);
}

TEST_CASE("Controller tip: turns about the fingertips of a gloved hand give the wrist at the controller") {
    const Pose wrist_at_controller{{0.02, -0.05, 0.07}, rotation({0.4, -1.1, 0.3})};
    const hand::Hand model = hand::make_hand(Side::right);
    const hand::Skeleton fingers = hand::joints(model, hand::closed_hand_angles(0.1), {});
    constexpr std::array order{hand::thumb_tip, hand::index_tip, hand::middle_tip, hand::little_tip,
                               hand::ring_tip};
    for (const double size : {1.0, 1.04}) {  // of the real hand, relative to the model
        CAPTURE(size);
        Random random(17);
        ScriptedController worn;
        // One fingertip every 10 s: Enter after 1 s, then 6 s of turns about it.
        worn.at = [&](double now) {
            const auto finger = std::min<std::size_t>(static_cast<std::size_t>(now / 10.0), 4);
            const Quat turn = rotation({0.5 * std::sin(3.0 * now), 0.5 * std::cos(2.0 * now), 0.0});
            const Vec3 tip = wrist_at_controller * (size * fingers.position[order[finger]]);
            const Vec3 noise(random.normal(), random.normal(), random.normal());
            return ControllerSample{pose_on(Vec3(0.1, 0.7, -0.2) + 1e-3 * noise, turn, tip), false};
        };
        worn.enter = {1.0, 11.0, 21.0, 31.0, 41.0};
        ControllerTip controller(worn.io(), {});
        const auto pairs = measure_fingertips(controller, [&]() -> Result<hand::Skeleton> {
            // The next finger is turned about after the ten seconds of this one.
            while (std::fmod(worn.time.now, 10.0) > 1.0) worn.time.now += 0.01;
            return fingers;
        });
        REQUIRE(pairs);
        REQUIRE(pairs->size() == 5);
        const auto measured =
            register_frames(content::CoordinateFrame::hand, content::CoordinateFrame::controller, *pairs,
                            "2026-03-02T09:15:00Z");
        REQUIRE_MESSAGE(measured, (measured ? "" : measured.error().message()));
        CHECK(check_quality(*measured));
        CHECK(warnings_of(*measured).empty());
        const Pose& pose = measured->registration.pose;
        MESSAGE("wrist off by " << glm::length(pose.position - wrist_at_controller.position) / mm
                                << " mm and "
                                << to_degrees(glm::length(
                                       turn_between(pose.orientation, wrist_at_controller.orientation)))
                                << " degrees");
        // A hand that is 4 % longer than the model puts the wrist nearer to the fingertips by 4 % of their
        // distance.
        CHECK(glm::length(pose.position - wrist_at_controller.position) < (size == 1.0 ? 1e-3 : 8e-3));
        CHECK(glm::length(turn_between(pose.orientation, wrist_at_controller.orientation)) < to_radians(1.0));
        CHECK(has(worn.shown, "Hold the tip of the ring finger on a fixed point"));
    }
    ScriptedController silent;
    silent.at = [](double now) {
        const Quat turn = rotation({0.5 * std::sin(3.0 * now), 0.5 * std::cos(2.0 * now), 0.0});
        return ControllerSample{pose_on({}, turn, Vec3(0.1, 0.0, 0.0)), now > 1.0};
    };
    ControllerTip controller(silent.io(), {});
    const auto lost = measure_fingertips(controller, []() -> Result<hand::Skeleton> {
        return fail(ErrorCode::no_device, "the glove sends no samples", "samples");
    });
    REQUIRE_FALSE(lost);
    CHECK(lost.error().code == ErrorCode::no_device);
}

}  // namespace controller_tip_test
