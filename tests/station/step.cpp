// What becomes of devices' samples and of the servo's output, without threads and without devices.
#include "haptics/station/step.hpp"

#include <doctest/doctest.h>

#include <cstring>

#include "engine/base/random.hpp"
#include "tests/station/support.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::station;
using device::Told;

namespace {

constexpr double dt = 1e-3;

Layout with_arm() {
    Layout layout;
    layout.mover = test::arm();
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    return layout;
}

// A station whose devices say what a test wants, every millisecond.
struct Rig {
    explicit Rig(const Layout& l)
        : layout(l),
          setup(test::two_joints(limits_of(l))),
          servo(servo::initial_state(setup)),
          state(initial_state(l)) {
        for (Told* told : {&heard.mover, &heard.wheel}) {
            told->usable = true;
            told->opening = 1;
        }
        heard.wishes.held = true;
        heard.wishes.grip = servo::Grip::wrench;
    }

    Layout layout;
    servo::Setup setup;
    servo::State servo;
    State state;
    Heard heard;
    bool mover_speaks = true, wheel_speaks = true;

    Answer tick() {
        if (mover_speaks) ++heard.mover.number;
        if (wheel_speaks) ++heard.wheel.number;
        return station::tick(layout, setup, state, servo, heard);
    }
    Answer ticks(int count) {
        Answer answer;
        for (int i = 0; i < count; ++i) answer = tick();
        return answer;
    }
    Pose& hand() { return heard.mover.sample.pose; }
    [[nodiscard]] const Pose& tool() const { return state.workspace.tool; }
};

// The tool on the first nut, aligned; a puck moves it, if anything.
Rig on_nut(Layout layout) {
    const servo::Setup setup = test::two_joints(limits_of(layout));
    const servo::NutPlace& nut = setup.nuts[0];
    const servo::DeviceSample at = test::tool_at(nut, servo::nut_centre(nut, 0.0), setup.wrench.head_angle);
    const servo::ToolPose pose = servo::pose_of(at);
    layout.home = {pose.position, pose.orientation};
    Rig rig(layout);
    rig.ticks(700);  // the ramp
    REQUIRE(rig.state.output.joint == 0);
    return rig;
}

bool nothing(const force::OutputCommand& c) { return c.force == Vec3(0.0) && c.torque == Vec3(0.0); }

}  // namespace

TEST_CASE("the tool begins at home wherever the hand is, and follows it, scaled") {
    Layout layout = with_arm();
    layout.workspace.scale = 3.0;
    layout.workspace.turn = rotation(Vec3(0, pi / 2, 0));
    Rig rig(layout);
    rig.hand() = {Vec3(0.05, -0.02, 0.01), rotation(Vec3(0.3, 0, 0))};
    rig.tick();
    CHECK(glm::length(rig.tool().position - layout.home.position) < 1e-12);
    CHECK(glm::length(rig.state.input.device.position[1] - 0.3F) < 1e-6F);
    for (int i = 0; i < 100; ++i) {
        rig.hand().position.x += 1e-4;
        rig.tick();
    }
    CHECK(glm::length(rig.tool().position - (layout.home.position + Vec3(0, 0, -0.03))) < 1e-9);
}

TEST_CASE("clutched, lost or plugged in elsewhere: the tool stays and follows on from there") {
    Rig rig(with_arm());
    rig.ticks(10);
    const Pose before = rig.tool();
    rig.heard.mover.sample.buttons = 2;
    for (int i = 0; i < 50; ++i) {
        rig.hand().position += Vec3(1e-3, 0, 0);
        rig.tick();
    }
    CHECK(rig.tool().position == before.position);
    rig.heard.mover.sample.buttons = 0;
    rig.ticks(10);
    CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
    // Unplugged, and plugged in again with the hand a foot away and turned.
    rig.heard.mover.usable = false;
    rig.mover_speaks = false;
    rig.ticks(100);
    rig.heard.mover.usable = rig.mover_speaks = true;
    ++rig.heard.mover.opening;
    rig.hand().position += Vec3(0, 0.3, 0);
    rig.hand().orientation = rotation(Vec3(0, 0, 1));
    rig.ticks(10);
    CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
    CHECK(rig.state.output.fault != force::Fault::jumped);
    rig.hand().position += Vec3(0, 0.001, 0);
    rig.tick();
    CHECK(glm::length(rig.tool().position - before.position) == doctest::Approx(0.001));
}

TEST_CASE("buttons do what they are set to, of what is plugged in only") {
    Rig rig(with_arm());
    rig.layout.mover_buttons = {4, 8, 16, 32};
    rig.heard.wishes.held = false;
    rig.tick();
    CHECK_FALSE(rig.state.input.enabled);
    rig.heard.mover.sample.buttons = 4 | 16;
    rig.tick();
    CHECK(rig.state.input.enabled);
    CHECK(rig.state.input.stop);
    CHECK(rig.state.output.fault == force::Fault::stopped);
    rig.heard.mover.sample.buttons = 32;
    rig.tick();
    CHECK(rig.state.input.reset);
    CHECK(rig.state.output.fault == force::Fault::none);
    rig.heard.mover.sample.buttons = 4;
    rig.heard.mover.usable = false;
    rig.tick();
    CHECK_FALSE(rig.state.input.enabled);
    rig.heard.missed = 40;
    rig.tick();
    CHECK(rig.state.input.missed == 15);
}

TEST_CASE("what a gloved hand grips is gripped, whatever is wished") {
    Rig rig = on_nut(with_arm());
    rig.heard.hand = servo::Grip::none;
    rig.tick();
    CHECK(rig.state.output.joint < 0);
    rig.heard.wishes.grip = servo::Grip::none;
    rig.heard.hand = servo::Grip::wrench;
    rig.ticks(5);
    CHECK(rig.state.output.joint == 0);
    rig.heard.hand.reset();
    rig.tick();
    CHECK(rig.state.output.joint < 0);
}

TEST_CASE("a silent device has no force 18 ms after its last sample, and gets it back over the ramp") {
    for (const bool lost : {false, true}) {
        Rig rig = on_nut(with_arm());
        rig.hand().position.z += 2e-3;  // the nut draws it back
        REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
        rig.mover_speaks = false;
        rig.heard.mover.usable = !lost;
        Answer answer = rig.ticks(7);
        if (!lost) CHECK(glm::length(answer.mover.force) > 1.0);
        answer = rig.ticks(11);
        CHECK(nothing(answer.mover));
        rig.ticks(100);
        CHECK(nothing(rig.tick().mover));
        rig.mover_speaks = rig.heard.mover.usable = true;
        double before = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const double now = glm::length(rig.tick().mover.force);
            CHECK(now - before < 0.1);
            before = now;
        }
        CHECK(before > 1.0);
    }
}

TEST_CASE("after a servo that hung forces begin anew, whatever happened meanwhile") {
    Layout layout;
    layout.mover = test::puck();
    layout.wheel = test::wheel_of(10.0);
    Rig rig = on_nut(layout);
    for (int i = 0; i < 30'000 && rig.state.output.wrench_torque < 150.0; ++i) {
        rig.heard.wheel.sample.turn += 1e-3;
        rig.tick();
    }
    REQUIRE(glm::length(rig.tick().wheel.torque) > 5.0);
    const auto hangs = [&] {
        rig.heard.missed = 300;
        CHECK(nothing(rig.tick().wheel));
        rig.heard.missed = 0;
    };
    SUBCASE("the wheel goes on") {
        hangs();
        double before = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const double now = glm::length(rig.tick().wheel.torque);
            CHECK(now - before < 0.1);
            before = now;
        }
        CHECK(before > 5.0);
    }
    SUBCASE("the dead-man was let go") {
        rig.heard.wishes.held = false;
        hangs();
        for (int i = 0; i < 1000; ++i) CHECK(nothing(rig.tick().wheel));
    }
    SUBCASE("the wheel was lost, after it had told something") {
        hangs();
        rig.wheel_speaks = false;
        for (int i = 0; i < 1000; ++i) CHECK(nothing(rig.tick().wheel));
        CHECK(rig.state.output.fault == force::Fault::silent);
    }
}

TEST_CASE("a puck pushes the tool, at its speed, for as long as it says so, and no further than obstacles") {
    Layout layout;
    layout.mover = test::puck();
    layout.workspace.turn = rotation(Vec3(0, 0, pi / 2));
    Rig rig(layout);
    rig.heard.wishes.grip = servo::Grip::none;
    rig.heard.mover.sample.velocity = Vec3(0.1, 0, 0);
    rig.heard.mover.sample.angular_velocity = Vec3(0, 0, 0.5);
    rig.ticks(1000);
    CHECK(glm::length(rig.tool().position - Vec3(0, 0.1, 0)) < 1e-4);
    CHECK(rotation_vector(rig.tool().orientation).z == doctest::Approx(0.5).epsilon(1e-3));
    CHECK(rig.state.output.fault == force::Fault::none);
    SUBCASE("it has gone quiet while pushed: not for long") {
        rig.mover_speaks = false;
        rig.ticks(2000);
        CHECK(rig.tool().position.y - 0.1 == doctest::Approx(0.1 * rate_lasts).epsilon(0.02));
    }
    SUBCASE("it is lost while pushed") {
        rig.heard.mover.usable = false;
        rig.ticks(2000);
        CHECK(rig.tool().position.y == doctest::Approx(0.1).epsilon(1e-3));
        CHECK(rig.state.output.fault == force::Fault::silent);
    }
    SUBCASE("the clutch holds it") {
        rig.heard.wishes.clutch = true;
        rig.ticks(2000);
        CHECK(rig.tool().position.y == doctest::Approx(0.1).epsilon(1e-3));
    }
    SUBCASE("something holds the tool back: the hand is not far inside it") {
        const Pose held = rig.state.output.tool;
        rig.heard.mover.sample.velocity = Vec3(0.3, 0, 0);
        for (int i = 0; i < 1000; ++i) {
            ++rig.heard.mover.number;
            hear(rig.layout, rig.setup, rig.state, rig.heard);
            rig.state.output.tool = held;
        }
        CHECK(glm::length(rig.tool().position - held.position) == doctest::Approx(ahead).epsilon(0.05));
        const Vec3 turned =
            rotation_vector(glm::normalize(rig.tool().orientation * glm::conjugate(held.orientation)));
        CHECK(glm::length(turned) <= turned_ahead * 1.01);
    }
}

TEST_CASE("a wheel turned with the clock tightens, as its user sees it, however its axis is counted") {
    for (const Vec3 axis : {Vec3(0, 0, -1), Vec3(0, 0, 1), Vec3(0, 1, 0), Vec3(0, -1, 0)}) {
        CAPTURE(axis.y);
        CAPTURE(axis.z);
        Layout layout;
        layout.mover = test::puck();
        layout.wheel = test::wheel_of(10.0, axis);
        Rig rig = on_nut(layout);
        // The user looks along −z, or down; with the clock is right-handed about where the user looks to.
        const double with_clock = axis.y + axis.z < 0.0 ? 1.0 : -1.0;
        Answer answer;
        for (int i = 0; i < 30'000 && rig.state.output.wrench_torque < 100.0; ++i) {
            rig.heard.wheel.sample.turn += with_clock * 1e-3;
            answer = rig.tick();
        }
        REQUIRE(rig.state.output.wrench_torque > 99.0);
        CHECK(rig.state.output.nut_angle > 0.5);
        // What it feels is the nut's torque, scaled to its motor, against the way it is turned.
        const double felt = glm::dot(answer.wheel.torque, axis) * -with_clock;
        CHECK(felt == doctest::Approx(rig.state.output.wrench_torque * rig.setup.torque.scale).epsilon(0.02));
        CHECK(glm::length(answer.wheel.torque) <= 10.0);
        CHECK(nothing(answer.mover));
        CHECK(rig.state.output.fault == force::Fault::none);

        // The wheel falls mute: nothing is left of that after 18 ms.
        rig.wheel_speaks = false;
        CHECK(nothing(rig.ticks(18).wheel));
        CHECK(rig.state.output.fault == force::Fault::silent);
    }
}

TEST_CASE("of two devices that are felt at once each is let go of by itself") {
    Layout layout = with_arm();
    layout.wheel = test::wheel_of(10.0);
    for (const bool arm_falls_mute : {true, false}) {
        Rig rig = on_nut(layout);
        rig.hand().position.z += 2e-3;
        for (int i = 0; i < 30'000 && rig.state.output.wrench_torque < 50.0; ++i) {
            rig.heard.wheel.sample.turn += 1e-3;
            rig.tick();
        }
        Answer answer = rig.tick();
        REQUIRE(rig.state.output.wrench_torque > 40.0);
        REQUIRE(glm::length(answer.mover.force) > 1.0);
        REQUIRE(glm::length(answer.wheel.torque) > 0.5);
        (arm_falls_mute ? rig.mover_speaks : rig.wheel_speaks) = false;
        answer = rig.ticks(18);
        if (arm_falls_mute) CHECK(nothing(answer.mover));
        CHECK(nothing(answer.wheel) == !arm_falls_mute);
    }
}

TEST_CASE("a wheel turns nothing when the wrench is on no nut, and what it turned meanwhile is forgotten") {
    Layout layout;
    layout.mover = test::puck();
    layout.wheel = test::wheel_of(10.0);
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    Rig rig(layout);
    rig.ticks(700);
    const Pose before = rig.tool();
    for (int i = 0; i < 1000; ++i) {
        rig.heard.wheel.sample.turn += 0.01;
        CHECK(nothing(rig.tick().wheel));
    }
    CHECK(rig.tool().orientation == before.orientation);
    CHECK(rig.tool().position == before.position);

    Rig on = on_nut(layout);
    const Pose there = on.tool();
    ++on.heard.wheel.opening;  // plugged in again, and its count begins anew
    on.heard.wheel.sample.turn = 40.0;
    on.ticks(5);
    CHECK(glm::length(rotation_vector(
              glm::normalize(on.tool().orientation * glm::conjugate(there.orientation)))) < 1e-9);
    CHECK(on.state.output.joint == 0);
}

TEST_CASE("layouts that cannot work are refused in words") {
    CHECK_FALSE(check({}));
    Layout layout;
    layout.mover = test::wheel_of(2.0);
    REQUIRE_FALSE(check(layout));
    CHECK(check(layout).error().message().find("a wheel turns about one axis") != std::string::npos);
    layout.mover = test::arm();
    CHECK(check(layout));
    layout.wheel = test::arm();
    CHECK_FALSE(check(layout));
    layout.wheel = test::wheel_of(2.0);
    CHECK(check(layout));
    layout.mover.reset();
    CHECK(check(layout));
}

TEST_CASE("what is rendered together: forces of the mover, torque of the wheel") {
    Layout layout;
    layout.mover = test::puck();
    CHECK(limits_of(layout).force == 0.0);
    CHECK(limits_of(layout).torque == 0.0);
    layout.wheel = test::wheel_of(7.0);
    CHECK(limits_of(layout).torque == 7.0);
    layout.mover = test::arm();
    layout.workspace.scale = 2.0;
    CHECK(limits_of(layout).force == doctest::Approx(0.5 * test::arm().limits.force));
    CHECK(limits_of(layout).torque == 7.0);
    layout.wheel.reset();
    CHECK(limits_of(layout).torque == test::arm().limits.torque);
    CHECK(limits_of(layout).release == doctest::Approx(0.018));
    layout.mover->renders = {true, true, true, false, false, false};
    CHECK(limits_of(layout).torque == 0.0);
}

TEST_CASE("a station's tick allocates nothing, waits for nothing; the same told gives the same bits") {
    const auto run = [](test::Forbidden* forbidden) {
        Layout layout = with_arm();
        layout.wheel = test::wheel_of(5.0);
        Rig rig = on_nut(layout);
        Random random(3);
        std::uint64_t hash = 14695981039346656037ULL;
        const auto all = [&] {
            for (int i = 0; i < 3000; ++i) {
                rig.heard.wheel.sample.turn += 2e-3 * random.uniform();
                rig.hand().position.x += 1e-5 * random.normal();
                rig.mover_speaks = !random.chance(0.1);
                const Answer answer = rig.tick();
                unsigned char bytes[sizeof answer];
                std::memcpy(bytes, &answer, sizeof answer);
                for (const unsigned char byte : bytes) hash = (hash ^ byte) * 1099511628211ULL;
            }
        };
        const test::Forbidden seen = test::forbidden_in(all);
        if (forbidden != nullptr) *forbidden = seen;
        return hash;
    };
    test::Forbidden forbidden;
    CHECK(run(&forbidden) == run(nullptr));
    CHECK(forbidden.all() == 0);
}

TEST_CASE("in a pause nothing is felt and nothing moves; afterwards forces come back over the ramp") {
    Rig rig = on_nut(with_arm());
    rig.hand().position.z += 2e-3;
    REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
    const Pose before = rig.tool();
    const std::uint64_t ticks = rig.servo.tick;
    const auto rests = [&](int count) {
        for (int i = 0; i < count; ++i) {
            ++rig.heard.mover.number;
            CHECK(nothing(pause(rig.layout, rig.setup, rig.state, rig.heard).mover));
        }
    };
    rests(100);
    rig.hand().position += Vec3(0.0, 0.3, 0.0);  // the arm is laid down
    rests(100);
    CHECK(rig.servo.tick == ticks);
    CHECK(glm::length(rig.tool().position - before.position) < 1e-12);
    SUBCASE("and goes on") {
        double last = 0.0;
        for (int i = 0; i < 1500; ++i) {
            const double now = glm::length(rig.tick().mover.force);
            CHECK(now - last < 0.1);
            last = now;
        }
        CHECK(last > 1.0);
        CHECK(glm::length(rig.tool().position - before.position) < 1e-9);
        CHECK(rig.servo.output.watchdog.counts[static_cast<std::size_t>(force::Fault::jumped)] == 0);
    }
    SUBCASE("a stop that was pressed meanwhile counts") {
        rig.layout.mover_buttons.stop = 16;
        rig.heard.mover.sample.buttons = 16;
        rests(5);
        rig.heard.mover.sample.buttons = 0;
        rests(5);
        rig.ticks(3);
        CHECK(rig.state.output.fault == force::Fault::stopped);
    }
}

TEST_CASE("marks are kept one a tick, a way back is asked for until it is granted, and then no more") {
    Layout layout;
    layout.mover = test::puck();
    layout.home.position = Vec3(0.1, 0.3, 0.0);
    Rig rig(layout);
    rig.ticks(10);
    CHECK(rig.servo.marked == 0);
    rig.heard.wishes.marks = 3;
    rig.ticks(2);
    CHECK(rig.servo.marked == 2);
    rig.ticks(10);
    CHECK(rig.servo.marked == 3);
    // As long as the tool is beside the nut nothing leaps.
    const Pose away = rig.tool();
    rig.heard.wishes.put.position = servo::nut_centre(rig.setup.nuts[0], 0.0) + Vec3(0.0, 0.05, 0.0);
    rig.heard.wishes.put_number = 1;
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(5);
    CHECK(glm::length(rig.tool().position - rig.heard.wishes.put.position) < 1e-9);
    rig.heard.wishes.back = 2;
    rig.heard.wishes.back_number = 7;
    rig.ticks(20);
    CHECK(rig.servo.marked == 3);
    CHECK(rig.state.input.undo == 2);
    rig.heard.wishes.put = away;
    rig.heard.wishes.put_number = 2;
    rig.ticks(20);
    CHECK(rig.servo.marked == 2);
    CHECK(rig.state.input.undo == 0);
    // The same once more has another number.
    rig.heard.wishes.back_number = 8;
    rig.ticks(20);
    CHECK(rig.servo.marked == 1);
}

TEST_CASE(
    "a wrench is taken where it lies, stays on the nut that the hand lets go of it on, and else goes back") {
    Layout layout = with_arm();
    Rig rig(layout);
    const servo::NutPlace& nut = rig.setup.nuts[0];
    const servo::ToolPose on =
        servo::pose_of(test::tool_at(nut, servo::nut_centre(nut, 0.0), rig.setup.wrench.head_angle));
    const Pose rest{Vec3(0.1, 0.01, 0.3), rotation(Vec3(0.0, 0.4, 0.0))};
    rig.heard.wishes.rest = rest;
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(5);
    REQUIRE(rig.state.lies);
    CHECK(rig.state.lies->position == rest.position);
    rig.heard.wishes.grip = servo::Grip::wrench;
    rig.tick();
    CHECK_FALSE(rig.state.lies);
    CHECK(glm::length(rig.tool().position - rest.position) < 1e-9);
    // From there it follows the hand.
    rig.hand().position += Vec3(0.0, 0.0, 1e-3);
    rig.tick();
    CHECK(glm::length(rig.tool().position - rest.position) == doctest::Approx(1e-3));
    rig.heard.wishes.put = {on.position, on.orientation};
    rig.heard.wishes.put_number = 1;
    rig.ticks(700);
    REQUIRE(rig.state.output.joint == 0);
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(5);
    REQUIRE(rig.state.lies);
    CHECK(glm::length(rig.state.lies->position - on.position) < 1e-3);
    rig.hand().position += Vec3(0.0, 0.02, 0.0);
    rig.tick();
    rig.heard.wishes.grip = servo::Grip::wrench;
    rig.tick();
    CHECK(glm::length(rig.tool().position - on.position) < 1e-3);
    // Let go of in the air.
    rig.hand().position += Vec3(0.0, 0.02, 0.0);
    rig.ticks(5);
    REQUIRE(rig.state.output.joint < 0);
    rig.heard.wishes.grip = servo::Grip::none;
    rig.ticks(2);
    CHECK(rig.state.lies->position == rest.position);
}

TEST_CASE(
    "a tool that is only pushed glides onto the nut, goes down with it, and comes off when it is pushed "
    "away") {
    Layout layout;
    layout.mover = test::puck();
    const servo::Setup setup = test::two_joints(limits_of(layout));
    const servo::NutPlace& nut = setup.nuts[0];
    layout.home = {servo::nut_centre(nut, 0.0) + Vec3(0.04, 0.09, 0.03), rotation(Vec3(-0.5 * pi, 0.0, 0.0))};
    Rig rig(layout);
    rig.heard.wishes.grip = servo::Grip::fingers;
    rig.ticks(1500);
    CHECK(rig.state.output.joint < 0);
    CHECK(glm::length(rig.tool().position - layout.home.position) < 1e-9);
    rig.heard.wishes.glide = 0;
    rig.ticks(4000);
    REQUIRE(rig.state.output.joint == 0);
    // Spun, with the clock as one sees it from above.
    rig.heard.mover.sample.angular_velocity = Vec3(0.0, -2.0, 0.0);
    rig.ticks(500);
    CHECK(rig.state.output.nut_angle == doctest::Approx(spinning * 1.0).epsilon(0.1));
    CHECK(rig.state.output.joint == 0);
    CHECK(glm::length(rig.tool().position - servo::nut_centre(nut, rig.state.output.nut_angle)) < 5e-3);
    rig.heard.mover.sample.angular_velocity = Vec3(0.0);
    rig.heard.mover.sample.velocity = Vec3(0.0, 0.2, 0.0);
    rig.ticks(800);
    CHECK(rig.state.output.joint < 0);
    CHECK(rig.tool().position.y > servo::nut_centre(nut, rig.state.output.nut_angle).y + 0.05);
    SUBCASE("a hand that is led by force is not moved besides") {
        Rig arm(with_arm());
        arm.heard.wishes.glide = 0;
        arm.ticks(2000);
        CHECK(glm::length(arm.tool().position - arm.layout.home.position) < 1e-12);
    }
}

TEST_CASE("what bears torque turns the more slowly when it is pushed round") {
    Layout layout;
    layout.mover = test::puck();
    Rig rig = on_nut(layout);
    rig.heard.mover.sample.angular_velocity = Vec3(0.0, -1.0, 0.0);
    double fastest = 0.0, last = 0.0;
    for (int i = 0; i < 60'000 && rig.state.output.wrench_torque < 150.0; ++i) {
        rig.tick();
        if (rig.state.output.wrench_torque > 50.0)
            fastest = std::max(fastest, rig.state.output.wrench_torque - last);
        last = rig.state.output.wrench_torque;
    }
    CHECK(rig.state.output.joint == 0);
    CHECK(last >= 150.0);
    CHECK(fastest < 0.2);  // N·m in a millisecond: a hand can stop within a second of the target
}

TEST_CASE("a gloved hand that lets go stays where it is: what moves on is its fingertips") {
    Layout layout = with_arm();
    layout.wrist = Pose{Vec3(0.12, 0.02, -0.03), rotation(Vec3(0.1, 0.2, 1.5))};
    Rig rig(layout);
    rig.heard.wishes.rest = Pose{Vec3(0.0, 0.01, 0.3), rotation(Vec3(0.0, 0.4, 0.0))};
    rig.heard.wishes.bare_wrist = Pose{Vec3(0.02, 0.1, 0.05), rotation(Vec3(-1.0, 0.2, 0.3))};
    const auto wrist = [&] {
        return in_hand(layout, rig.setup, rig.state, rig.heard.wishes) * *layout.wrist;
    };
    rig.heard.hand = servo::Grip::none;
    rig.ticks(5);
    const Pose bare = rig.tool() * *rig.heard.wishes.bare_wrist;
    CHECK(glm::distance(wrist().position, bare.position) < 1e-12);
    rig.heard.hand = servo::Grip::wrench;
    rig.ticks(5);
    CHECK(glm::distance(rig.tool().position, rig.heard.wishes.rest->position) < 1e-9);
    const Pose holding = wrist();
    CHECK(glm::distance(holding.position, (rig.tool() * *layout.wrist).position) < 1e-12);
    rig.heard.hand = servo::Grip::none;
    rig.ticks(2);
    CHECK(glm::distance(wrist().position, holding.position) < 1e-9);
    CHECK(std::abs(glm::dot(wrist().orientation, holding.orientation)) > 1.0 - 1e-9);
    CHECK(glm::distance(rig.tool().position, rig.heard.wishes.rest->position) > 0.01);
    // Beside the wrench that lies there it has its hand about the handle.
    rig.heard.wishes.put = *rig.state.lies * Pose{Vec3(0.1, 0.03, 0.02), rotation(Vec3(0.3, 0.0, 0.0))};
    rig.heard.wishes.put_number = 1;
    rig.ticks(2);
    CHECK(glm::distance(wrist().position, (*rig.state.lies * *layout.wrist).position) < 1e-9);
}

TEST_CASE("a window that hangs holds no dead-man, a button of the device does") {
    Rig rig = on_nut(with_arm());
    rig.hand().position.z += 2e-3;
    rig.heard.wishes.lasts = 0.5;
    REQUIRE(glm::length(rig.ticks(50).mover.force) > 1.0);
    rig.heard.age = 0.51;
    CHECK(nothing(rig.ticks(25).mover));
    CHECK_FALSE(rig.state.input.enabled);
    rig.heard.mover.sample.buttons = 1;
    rig.tick();
    CHECK(rig.state.input.enabled);
    rig.heard.mover.sample.buttons = 0;
    rig.heard.age = 0.0;
    rig.tick();
    CHECK(rig.state.input.enabled);
}
