// Devices without hardware: simulated, recorded, mouse and keyboard.
#include <doctest/doctest.h>

#include "haptics/device/simulated_arm.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/device/support.hpp"

using namespace bolt;
using namespace bolt::device;

namespace {

ScriptedDeviceOptions still(std::optional<HandImpedance> hand = std::nullopt) {
    return {test::arm(), [](double) { return Sample{}; }, hand, {}};
}

std::unique_ptr<DeviceDriver> opened(const DeviceFactory& open) {
    auto device = open();
    REQUIRE(device);
    return std::move(*device);
}

// Returns the samples until the time `until`, with a read timeout of 1 ms.
std::vector<Sample> read_until(DeviceDriver& device, const VirtualTime& time, double until) {
    std::vector<Sample> samples;
    while (time.now < until) {
        const auto read = device.read(1e-3);
        REQUIRE(read);
        if (*read) samples.push_back(**read);
    }
    return samples;
}

}  // namespace

TEST_CASE("ScriptedDevice: the hand follows its script at the device's rate") {
    VirtualTime time;
    Description description = test::arm();
    description.rate = 250.0;
    ScriptedDevice thing({description,
                          [](double t) {
                              Sample s;
                              s.pose.position.x = 0.1 * t;
                              s.buttons = t > 0.5 ? 1 : 0;
                              return s;
                          },
                          std::nullopt,
                          {}},
                         virtual_timer(time));
    const auto device = opened(thing.factory());
    const auto samples = read_until(*device, time, 1.0);
    CHECK(samples.size() == doctest::Approx(250).epsilon(0.02));
    for (const Sample& s : samples) CHECK(s.pose.position.x == doctest::Approx(0.1 * s.time));
    CHECK(samples.back().buttons == 1);
}

TEST_CASE(
    "ScriptedDevice: a held device rests where force and hand spring balance, in translation and rotation") {
    VirtualTime time;
    const HandImpedance hand;
    ScriptedDevice thing(still(hand), virtual_timer(time));
    const auto device = opened(thing.factory());
    read_until(*device, time, 0.1);
    REQUIRE(device->write({Vec3(3, 0, -1.5), Vec3(0, 0.2, 0)}));
    read_until(*device, time, 3.0);
    CHECK(thing.hand().pose.position.x == doctest::Approx(3.0 / hand.stiffness).epsilon(1e-3));
    CHECK(thing.hand().pose.position.z == doctest::Approx(-1.5 / hand.stiffness).epsilon(1e-3));
    CHECK(rotation_vector(thing.hand().pose.orientation).y ==
          doctest::Approx(0.2 / hand.torsion).epsilon(1e-3));
    // Commands beyond the limits are clamped.
    REQUIRE(device->write({Vec3(300, 0, 0), Vec3(0.0)}));
    CHECK(thing.rendered().force.x == doctest::Approx(test::arm().limits.force));
}

TEST_CASE("ScriptedDevice: a wheel turns against the hand about its own axis") {
    VirtualTime time;
    Description wheel = test::arm();
    wheel.sensing = Sensing::angle;
    wheel.axis = Vec3(0, 1, 0);
    wheel.limits.torque = 10.0;
    const HandImpedance hand;
    ScriptedDevice thing({wheel, [](double) { return Sample{}; }, hand, {}}, virtual_timer(time));
    const auto device = opened(thing.factory());
    read_until(*device, time, 0.1);
    REQUIRE(device->write({Vec3(0.0), Vec3(5, 4, 0)}));
    read_until(*device, time, 3.0);
    CHECK(thing.hand().angle == doctest::Approx(4.0 / hand.torsion).epsilon(1e-3));
}

TEST_CASE("ScriptedDevice: each injected fault behaves as named, for its interval") {
    VirtualTime time;
    ScriptedDevice thing(still(), virtual_timer(time));
    auto device = opened(thing.factory());
    thing.inject({InjectedFault::silent, 1.0, 2.0});
    CHECK(read_until(*device, time, 1.0).size() > 990);
    REQUIRE(device->write({Vec3(1, 0, 0), Vec3(0.0)}));
    CHECK(read_until(*device, time, 2.0).size() <= 1);
    CHECK(thing.rendered().force.x == 1.0);  // a silent device keeps its last force

    thing.inject({InjectedFault::not_a_number, 2.0, 2.5});
    for (const Sample& s : read_until(*device, time, 2.4)) CHECK(std::isnan(s.pose.position.y));
    read_until(*device, time, 3.0);
    thing.inject({InjectedFault::jumped, 3.0, 3.5});
    for (const Sample& s : read_until(*device, time, 3.4)) CHECK(s.pose.position.x == 0.5);
    read_until(*device, time, 4.0);

    thing.inject({InjectedFault::slow, 4.0, 5.0});
    REQUIRE(device->write({Vec3(2, 0, 0), Vec3(0.0)}));
    CHECK(time.now == doctest::Approx(4.015).epsilon(1e-3));
    read_until(*device, time, 5.0);
    thing.inject({InjectedFault::stuck, 5.0, 5.7});
    REQUIRE(device->write({Vec3(3, 0, 0), Vec3(0.0)}));
    CHECK(time.now > 5.7);

    thing.inject({InjectedFault::unplugged, 6.0, 7.0});
    while (time.now < 5.995) REQUIRE(device->read(1e-3));
    REQUIRE(thing.rendered().force.x == 3.0);
    time.now = 6.0;
    CHECK(thing.rendered().force.x == 0.0);
    const auto read = device->read(1e-3);
    REQUIRE_FALSE(read);
    CHECK(read.error().lost);
    CHECK_FALSE(device->write({}));
    CHECK_FALSE(thing.factory()());
    device.reset();
    time.now = 7.0;
    CHECK(thing.factory()());
}

TEST_CASE(
    "Recorded: samples play at their own pace, late readers get the latest, and buttons are released at the "
    "end") {
    VirtualTime time;
    time.now = 100.0;
    const auto recording = [](std::size_t i) -> std::optional<Sample> {
        if (i >= 500) return std::nullopt;
        Sample s;
        s.time = 5.0 + 2e-3 * static_cast<double>(i);
        s.pose.position.x = static_cast<double>(i);
        s.buttons = 1;
        return s;
    };
    const DeviceFactory open = recorded(test::arm(), recording, virtual_timer(time));
    {
        const auto device = opened(open);
        const auto samples = read_until(*device, time, 100.5);
        REQUIRE(samples.size() == doctest::Approx(250).epsilon(0.02));
        for (std::size_t i = 0; i < samples.size(); ++i)
            CHECK(samples[i].pose.position.x == static_cast<double>(i));
        time.now = 100.9;
        const auto late = device->read(1e-3);
        REQUIRE(late);
        REQUIRE(*late);
        CHECK((*late)->pose.position.x == doctest::Approx(450).epsilon(0.01));
        const auto rest = read_until(*device, time, 101.5);
        CHECK(rest.back().pose.position.x == 499);
        CHECK(rest.back().buttons == 0);
        CHECK(rest.size() > 400);  // the last sample repeats
    }
    const auto again = opened(open);
    const auto first = again->read(1e-3);
    REQUIRE(first);
    REQUIRE(*first);
    CHECK((*first)->pose.position.x == 0.0);
    CHECK_FALSE(recorded(
        test::arm(), [](std::size_t) { return std::optional<Sample>{}; }, virtual_timer(time))());
}

TEST_CASE("VirtualPuck: deflection becomes velocity, quadratically; without input it rests") {
    VirtualTime time;
    const VirtualPuckOptions feel;
    VirtualPuck puck(feel, virtual_timer(time));
    const auto device = opened(puck.factory());
    CHECK(device->description().sensing == Sensing::velocity);
    CHECK(read_until(*device, time, 0.1).back().velocity == Vec3(0.0));
    puck.set_input({Vec3(1, -0.5, 7), Vec3(0, 0.5, 0), 2});
    const Sample pushed = read_until(*device, time, 0.2).back();
    CHECK(pushed.velocity.x == doctest::Approx(feel.speed));
    CHECK(pushed.velocity.y == doctest::Approx(-0.25 * feel.speed));
    CHECK(pushed.velocity.z == doctest::Approx(feel.speed));
    CHECK(pushed.angular_velocity.y == doctest::Approx(0.25 * feel.angular_speed));
    CHECK(pushed.buttons == 2);
    const auto rest = read_until(*device, time, 1.0);
    CHECK(rest.back().velocity == Vec3(0.0));
    CHECK(rest.back().buttons == 0);
    CHECK(rest.size() == doctest::Approx(0.8 * feel.rate).epsilon(0.05));
}

TEST_CASE("Devices: simulated, recorded and virtual devices keep the driver contract") {
    VirtualTime time;
    const auto by_itself = [] {};
    ScriptedDevice thing(still(HandImpedance{}), virtual_timer(time));
    test::check_driver_contract(thing.factory(), by_itself);
    test::check_unplugged(thing.factory(), [&] { thing.inject({InjectedFault::unplugged, time.now, 1e9}); });
    const auto forever = [](std::size_t i) {
        std::optional<Sample> sample(std::in_place);
        sample->time = 1e-3 * static_cast<double>(i);
        return sample;
    };
    test::check_driver_contract(recorded(test::arm(), forever, virtual_timer(time)), by_itself);
    VirtualPuck puck({}, virtual_timer(time));
    test::check_driver_contract(puck.factory(), [&] { puck.set_input({Vec3(1, 0, 0), Vec3(0, 1, 0), 1}); });
}

TEST_CASE("SimulatedArm: a hand that is no longer measured stops where the arm is") {
    VirtualTime time;
    SimulatedArm arm(simulated_arm_description(), simulated_arm_parameters(), virtual_timer(time));
    const auto device = opened(arm.factory());
    HandMotion motion;
    for (int i = 0; i < 200; ++i) {  // the hand moves at 0.5 m/s
        motion.target = Pose{Vec3(0.5e-3 * i, 0.0, 0.0), Quat(1.0, 0.0, 0.0, 0.0)};
        arm.set_motion(motion);
        read_until(*device, time, time.now + 1e-3);
    }
    motion.target.reset();
    arm.set_motion(motion);
    const double lost_at = read_until(*device, time, time.now + 1e-3).back().pose.position.x;
    const Sample rest = read_until(*device, time, time.now + 2.0).back();
    // The intended pose is the arm's pose in that moment; dry friction holds the arm within 0.05 N / 300 N/m.
    CHECK(std::abs(rest.pose.position.x - lost_at) < 1e-3);
}
