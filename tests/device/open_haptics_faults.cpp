// The driver of OpenHaptics' arms, on an emulated library: limits and the end of the force, and faults.
#include <doctest/doctest.h>

#include "tests/device/open_haptics_bench.hpp"

namespace device_open_haptics_faults_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;
using Bench = OpenHapticsBench;

namespace {

constexpr double max_release_time = 0.02;  // s, the longest time from a fault to a hand without force

// Holds 2 N, causes the fault and keeps commanding 2 N. The hand must be free in time.
template <class Cause>
void check_lets_go(Bench& bench, DeviceDriver& device, const Cause& cause) {
    REQUIRE(bench.drive(device, two_newton, 0.05));
    REQUIRE(bench.force_now() == doctest::Approx(2.0));
    cause();
    const double until = bench.now + max_release_time;
    bench.drive(device, two_newton, max_release_time);
    bench.timer.wait(until - bench.now);  // a lost arm refuses commands
    CHECK(bench.force_now() == 0.0);
}

}  // namespace

TEST_CASE(
    "OpenHaptics: the force is limited, ends with the commands, and is released when the arm is closed") {
    Bench bench;
    auto device = bench.opened();
    REQUIRE(bench.drive(*device, {Vec3(100, 0, 0), {}}, 0.05));
    CHECK(bench.force_now() == doctest::Approx(3.3));
    // The device thread hangs: no further calls.
    for (int i = 0; i < 15; ++i) bench.timer.wait(1e-3);
    CHECK(bench.force_now() == doctest::Approx(3.3));
    for (int i = 0; i < 5; ++i) bench.timer.wait(1e-3);
    CHECK(bench.force_now() == 0.0);
    // It comes back with the next command.
    REQUIRE(bench.drive(*device, two_newton, 0.005));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    const double closing = bench.now;
    device.reset();
    CHECK(bench.now - closing < max_release_time);
    CHECK(bench.force_now() == 0.0);
    CHECK(bench.arm.running() == 0);
    CHECK(bench.arm.open() == 0);
    CHECK(bench.arm.refused() == 0);
}

TEST_CASE(
    "OpenHaptics: warm motors end the force until they are cool; the arm stays open and the force grows "
    "slowly") {
    Bench bench;
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] { bench.arm.heat(1.0); });
    REQUIRE(bench.drive(*device, two_newton, 3.0));
    CHECK(bench.force_now() == 0.0);
    bench.arm.heat(0.8);  // no error any more, and not yet cool
    REQUIRE(bench.drive(*device, two_newton, 3.0));
    CHECK(bench.force_now() == 0.0);
    bench.arm.heat(0.5);
    double greatest_step = 0.0;
    for (int i = 0; i < 600; ++i) {
        const double before = bench.force_now();
        REQUIRE(bench.drive(*device, two_newton, 1e-3));
        greatest_step = std::max(greatest_step, bench.force_now() - before);
    }
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(greatest_step < 0.02);
}

TEST_CASE("OpenHaptics: the force of hot motors fades before the library warns, and the health reports it") {
    Bench bench;
    auto device = bench.opened();
    CHECK(device->description().model == "Touch");
    CHECK(device->description().serial == "2001-0042");
    REQUIRE(bench.drive(*device, two_newton, 1.0));
    CHECK(device->health().calibrated == true);
    CHECK(device->health().heat == 0.0);
    bench.arm.heat(0.85);
    REQUIRE(bench.drive(*device, two_newton, 0.5));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(is_warm(device->health()));
    bench.arm.heat(0.97);
    REQUIRE(bench.drive(*device, two_newton, 0.05));
    CHECK(bench.force_now() == 0.0);
    CHECK(device->health().cooling);
    CHECK(device->health().heat == 0.97);
    bench.arm.heat(0.6);
    REQUIRE(bench.drive(*device, two_newton, 0.7));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK_FALSE(device->health().cooling);
}

TEST_CASE("OpenHaptics: an arm that is too fast or forced too hard rests for half a second and stays open") {
    for (const unsigned error : {0x201U, 0x202U, 0x203U}) {
        CAPTURE(error);
        Bench bench;
        auto device = bench.opened();
        check_lets_go(bench, *device, [&] { bench.arm.raise(error); });
        REQUIRE(bench.drive(*device, two_newton, 0.3));
        CHECK(bench.force_now() == 0.0);
        REQUIRE(bench.drive(*device, two_newton, 1.0));
        CHECK(bench.force_now() == doctest::Approx(2.0));
        bench.arm.switch_off();  // the library disables the forces, and refuses them from then on
        REQUIRE(bench.drive(*device, two_newton, 0.3));
        CHECK(bench.force_now() == 0.0);
        REQUIRE(bench.drive(*device, two_newton, 1.0));
        CHECK(bench.force_now() == doctest::Approx(2.0));
    }
    // A hand that is pulled away with 60 N.
    Bench bench;
    bench.arm.speed_limit(0.5);
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] {
        bench.arm.intend(0.2, 0, 0);
        REQUIRE(bench.drive(*device, two_newton, 0.005));  // until it is too fast
    });
    REQUIRE(bench.drive(*device, two_newton, 3.0));
    CHECK(bench.force_now() == doctest::Approx(2.0));
}

TEST_CASE("OpenHaptics: a transform that is not a number ends the force and yields no sample") {
    Bench bench;
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] { bench.arm.corrupt(1); });
    const auto sample = device->read(0.05);
    REQUIRE(sample);
    CHECK_FALSE(*sample);
    bench.arm.corrupt(0);
    REQUIRE(bench.drive(*device, two_newton, 1.0));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(is_valid(device->description(), bench.read(*device, 0.01)));
}

TEST_CASE("OpenHaptics: faults of the arm end the force, and the arm is lost") {
    for (const unsigned fault : {0x300U, 0x302U, 0x304U, 0x402U}) {
        CAPTURE(fault);
        Bench bench;
        auto device = bench.opened();
        // Errors lie on a stack; a harmless one on top must not hide the fault.
        check_lets_go(bench, *device, [&] {
            bench.arm.raise(fault);
            bench.arm.heat(1.0);
            CHECK_FALSE(bench.drive(*device, two_newton, 0.0025));
            bench.arm.heat(0.0);
        });
        const auto sample = device->read(0.005);
        REQUIRE_FALSE(sample);
        CHECK(sample.error().lost);
        CHECK(sample.error().code == ErrorCode::no_device);
        CHECK_FALSE(device->write(two_newton));
        for (int i = 0; i < 1000; ++i) {
            CHECK_FALSE(device->write(two_newton));
            bench.timer.wait(1e-3);
        }
        CHECK(bench.force_now() == 0.0);
        device.reset();
        CHECK(bench.open());  // as the supervisor does
    }
    Bench bench;
    auto device = bench.opened();
    check_lets_go(bench, *device, [&] { bench.arm.unplug(1); });
    const auto sample = device->read(0.005);
    REQUIRE_FALSE(sample);
    CHECK(sample.error().message() ==
          "OpenHaptics arm (Touch): its forces have ended: communication error; expected an arm that is "
          "switched on, connected, and set up with the vendor's program Touch_Setup");
}

TEST_CASE("OpenHaptics: a late tick delays samples; after a very late one the force grows from zero") {
    Bench bench;
    auto device = bench.opened();
    REQUIRE(bench.drive(*device, two_newton, 0.05));
    bench.arm.late(0.01);
    const auto none = device->read(0.008);
    REQUIRE(none);
    CHECK_FALSE(*none);
    REQUIRE(bench.drive(*device, two_newton, 0.05));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    // The library keeps rendering the last force while its thread hangs.
    bench.arm.late(0.2);
    const double late = bench.now;
    while (bench.force_now() > 0.0 && bench.now < late + 0.15)
        REQUIRE(bench.drive(*device, two_newton, 1e-3));
    CHECK(bench.now - late < max_release_time);
    REQUIRE(bench.drive(*device, two_newton, 0.25));
    CHECK(bench.force_now() > 0.0);
    CHECK(bench.force_now() < 1.0);
    REQUIRE(bench.drive(*device, two_newton, 0.6));
    CHECK(bench.force_now() == doctest::Approx(2.0));
    CHECK(bench.arm.refused() == 0);
    CHECK(bench.read(*device, 0.005).time > bench.now - 0.003);
    bench.arm.late(10.0);
    const double closing = bench.now;
    device.reset();
    CHECK(bench.now - closing < max_release_time + 1e-3);
    CHECK(bench.force_now() == 0.0);
}

}  // namespace device_open_haptics_faults_test
