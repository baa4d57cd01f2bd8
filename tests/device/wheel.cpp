#include "tools/emulate/wheel.hpp"

#include <doctest/doctest.h>

#include <limits>

#include "haptics/device/wheel.hpp"
#include "tests/device/driver_contract.hpp"
#include "tools/emulate/hid_device.hpp"

namespace device_wheel_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

struct Bench {
    explicit Bench(const emulate::EmulatedWheelOptions& design, const WheelConfig& rig_ = {})
        : rig(rig_), wheel(design) {
        plug.device = &wheel;
        if (!design.board) rig.range = to_radians(design.degrees);
        rig.full_torque = design.full_torque;
        opened = open();
        if (opened) device = std::move(*opened);
    }
    Result<std::unique_ptr<DeviceDriver>> open() {
        const auto descriptor = parse_report_descriptor(wheel.description().descriptor);
        REQUIRE_MESSAGE(descriptor, (descriptor ? "" : descriptor.error().message()));
        const auto make = wheel.description().vendor == 0x1209 ? make_open_ffboard : make_wheel;
        return make(std::make_unique<emulate::EmulatedTransport>(plug), *descriptor, "Wheel", "1:2", rig,
                    [this] { return plug.time; });
    }
    // Reads and writes like an I/O thread.
    template <class F>
    void run(double seconds, const F& command) {
        for (const double until = plug.time + seconds; plug.time < until;) {
            const auto sample = device->read(0.002);
            REQUIRE(sample);
            if (*sample) last = **sample;
            samples += *sample ? 1 : 0;
            REQUIRE(device->write({.torque = rig.axis * command()}));
        }
    }

    WheelConfig rig;
    emulate::EmulatedWheel wheel;
    emulate::EmulatedLink plug;
    Result<std::unique_ptr<DeviceDriver>> opened = fail(ErrorCode::failed, "not opened", "opened");
    std::unique_ptr<DeviceDriver> device;
    Sample last;
    int samples = 0;
};

emulate::EmulatedWheelOptions design_of(bool board) { return {.board = board, .power = board ? 0.5 : 1.0}; }

}  // namespace

TEST_CASE("Wheel: the motor renders the commanded torque in both directions, up to the described limit") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        Bench b(design_of(board), {.max_torque = 3.0});
        REQUIRE_MESSAGE(b.opened, (b.opened ? "" : b.opened.error().message()));
        CHECK(b.device->description().limits.torque == doctest::Approx(3.0));
        CHECK(b.device->description().limits.force == 0.0);
        CHECK(b.device->description().renders[5]);
        CHECK(!b.device->description().renders[3]);
        for (const double torque : {0.5, -1.25, 3.0, 0.0, -3.0}) {
            b.run(0.01, [&] { return torque; });
            CHECK(b.wheel.torque() == doctest::Approx(torque).epsilon(0.001).scale(10.0));
        }
        b.run(0.01, [] { return 50.0; });
        CHECK(b.wheel.torque() == doctest::Approx(3.0).epsilon(0.002));
        b.run(0.01, [] { return std::numeric_limits<double>::quiet_NaN(); });
        CHECK(b.wheel.torque() == 0.0);
        // Only the torque about the axis is rendered.
        REQUIRE(b.device->write({.force = Vec3(5.0), .torque = {2.0, 2.0, 0.0}}));
        CHECK(b.wheel.torque() == 0.0);
    }
}

TEST_CASE(
    "Wheel: a motor stronger than configured pulls more and a weaker one less; the default assumes the "
    "strongest") {
    Bench b({.full_torque = 10.0, .power = 1.0});
    b.device.reset();
    b.rig.full_torque = WheelConfig{}.full_torque;
    auto made = b.open();
    REQUIRE(made);
    b.device = std::move(*made);
    b.run(0.01, [] { return 1.0; });
    CHECK(b.wheel.torque() > 0.0);
    CHECK(b.wheel.torque() < 1.0);
}

TEST_CASE("Wheel: the angle follows the hand and the torque") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        Bench b(design_of(board));
        REQUIRE(b.opened);
        b.wheel.hand_stiffness = 20.0;
        b.wheel.hand = 1.5;
        b.run(3.0, [] { return 0.0; });
        CHECK(b.wheel.angle() == doctest::Approx(1.5).epsilon(0.01));
        CHECK(b.last.angle == doctest::Approx(b.wheel.angle()).epsilon(0.001));
        b.wheel.hand = -2.0;
        b.run(3.0, [] { return 0.0; });
        CHECK(b.last.angle == doctest::Approx(-2.0).epsilon(0.01));
        b.wheel.hand = 0.0;
        b.run(4.0, [] { return -2.0; });
        CHECK(b.last.angle == doctest::Approx(-0.1).epsilon(0.05));  // torque divided by the hand's stiffness
    }
}

TEST_CASE("Wheel: a spring rendered through the driver holds the wheel still") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        Bench b(design_of(board), {.max_torque = 4.0});
        REQUIRE(b.opened);
        b.wheel.hand_stiffness = 5.0;
        b.wheel.hand = 0.8;
        b.run(6.0, [&] { return 5.0 * (0.2 - b.last.angle); });
        CHECK(b.wheel.angle() == doctest::Approx(0.5).epsilon(0.02));
        const double rests = b.wheel.angle();
        b.run(0.5, [&] { return 5.0 * (0.2 - b.last.angle); });
        CHECK(std::abs(b.wheel.angle() - rests) < 1e-3);
    }
}

TEST_CASE("Wheel: a spring of the described stiffness is stable on a wheel with little damping") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        emulate::EmulatedWheelOptions design = design_of(board);
        design.damping = 0.1;
        Bench b(design, {.max_torque = 5.0});
        REQUIRE(b.opened);
        b.plug.write_duration = 0.001;  // s, transfer time on the bus
        const double stiffness = b.device->description().limits.torsion;
        b.run(1.0, [] { return 1.0; });  // moves the wheel away from the spring's rest angle
        const auto spring = [&] { return -stiffness * b.last.angle; };
        double last = 1e9;
        for (int second = 0; second < 4; ++second) {
            double most = 0.0;
            b.run(1.0, [&] {
                most = std::max(most, std::abs(b.wheel.angle()));
                return spring();
            });
            CHECK(most < std::max(0.5 * last, 1e-3));
            last = most;
        }
    }
}

TEST_CASE("Wheel: an OpenFFBoard with known counts per turn has no angle limit and returns samples at rest") {
    Bench b({}, {.counts_per_turn = 4000.0});
    REQUIRE(b.opened);
    b.wheel.hand_stiffness = 50.0;
    for (double turns = 0.5; turns <= 6.0; turns += 0.5) {  // the stops are at 1.5 turns
        b.wheel.hand = turns * 2.0 * pi;
        b.run(2.0, [] { return 0.0; });
        CHECK(b.last.angle == doctest::Approx(b.wheel.hand).epsilon(0.01));
    }
    b.samples = 0;
    b.run(1.0, [] { return 0.0; });
    CHECK(b.samples > 400);

    Bench by_range({});
    by_range.run(1.0, [] { return 0.0; });
    CHECK(by_range.samples > 150);
    const std::uint64_t heard = by_range.wheel.reports_received();
    by_range.run(1.0, [] { return 0.0; });
    CHECK(by_range.wheel.reports_received() - heard < 300);
    by_range.wheel.stalled = true;
    by_range.run(0.1, [] { return 0.0; });
    by_range.samples = 0;
    by_range.run(0.5, [] { return 0.0; });
    CHECK(by_range.samples == 0);
}

TEST_CASE("Wheel: a silent wheel returns samples at rest for a while, then none") {
    Bench b(design_of(false));
    b.run(0.2, [] { return 0.0; });
    CHECK(b.samples > 50);
    b.run(1.0, [] { return 0.0; });
    b.samples = 0;
    b.run(0.5, [] { return 0.0; });
    CHECK(b.samples == 0);
}

TEST_CASE("Wheel: a force that the device drops is refreshed; closing releases it") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        emulate::EmulatedWheelOptions design = design_of(board);
        design.effect_life = 0.6;
        Bench b(design);
        REQUIRE(b.opened);
        b.wheel.hand_stiffness = 30.0;
        for (int i = 0; i < 60; ++i) {
            b.run(0.1, [] { return 1.0; });
            CHECK(b.wheel.torque() == doctest::Approx(1.0).epsilon(0.002));
        }
        b.device.reset();
        CHECK(b.wheel.torque() == 0.0);
        if (board) CHECK(!b.wheel.has_effect());
    }
}

TEST_CASE("Wheel: the device's own centring spring is stopped") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        emulate::EmulatedWheelOptions design = design_of(board);
        design.centring_spring = 3.0;
        emulate::EmulatedWheel alone(design);
        alone.hand = 1.0;
        alone.hand_stiffness = 10.0;
        for (double t = 0.0; t < 3.0; t += 0.001) alone.advance(t);
        CHECK(alone.angle() < 0.8);
        Bench b(design);
        REQUIRE(b.opened);
        b.wheel.hand = 1.0;
        b.wheel.hand_stiffness = 10.0;
        b.run(3.0, [] { return 0.0; });
        CHECK(b.wheel.angle() == doctest::Approx(1.0).epsilon(0.01));
    }
}

TEST_CASE("Wheel: a force outlives a killed program by one second at most, and returns with the program") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        Bench b(design_of(board));
        REQUIRE(b.opened);
        b.wheel.hand_stiffness = 30.0;
        b.run(2.0, [] { return 1.0; });
        b.plug.time += 1.01;
        b.wheel.advance(b.plug.time);
        CHECK(b.wheel.torque() == 0.0);
        b.run(0.01, [] { return 1.0; });
        CHECK(b.wheel.torque() == doctest::Approx(1.0).epsilon(0.002));
    }
}

TEST_CASE("Wheel: a missing or silent device gives a clear error, and an unplugged one is lost") {
    {
        emulate::EmulatedWheel dead;
        dead.stalled = true;
        emulate::EmulatedLink plug{.device = &dead};
        const auto descriptor = parse_report_descriptor(dead.description().descriptor);
        REQUIRE(descriptor);
        const auto made = make_open_ffboard(std::make_unique<emulate::EmulatedTransport>(plug), *descriptor,
                                            "Board", "1:2", {}, [&] { return plug.time; });
        REQUIRE(!made);
        CHECK(made.error().message().find("does not report") != std::string::npos);
        CHECK(plug.time < 1.0);
    }
    Bench b({});
    b.plug.unplugged = true;
    const auto sample = b.device->read(0.01);
    REQUIRE(!sample);
    CHECK(sample.error().lost);
    CHECK(!b.device->write({.torque = {0, 0, 1}}));
}

TEST_CASE("Wheel: corrupt reports never move the angle beyond the stops, and reading continues") {
    Bench b({.faults = {.truncated = 0.1, .unknown_id = 0.1, .changed = 0.1, .seed = 9}});
    REQUIRE(b.opened);
    for (int i = 0; i < 2000; ++i) {
        b.run(0.004, [] { return 0.5; });
        CHECK(std::isfinite(b.last.angle));
        CHECK(std::abs(b.last.angle) <= 0.5 * to_radians(1080.0) + 1e-9);
    }
    CHECK(b.samples > 1000);

    // A query is retried if its reply is lost.
    Bench counts({.faults = {.truncated = 0.1, .unknown_id = 0.1, .seed = 9}}, {.counts_per_turn = 4000.0});
    REQUIRE(counts.opened);
    counts.run(8.0, [] { return 0.0; });
    CHECK(counts.samples > 1000);
}

TEST_CASE("Wheel: wheels keep the driver contract, also without power") {
    for (const bool board : {true, false})
        for (const double power : {0.5, 0.0}) {
            if (!board && power == 0.0) continue;
            Bench b({.board = board, .power = power});
            REQUIRE(b.opened);
            b.device.reset();
            CHECK(b.plug.time < 1.0);
            const DeviceFactory open = [&]() -> Result<std::unique_ptr<DeviceDriver>> {
                if (b.plug.unplugged) return fail(ErrorCode::no_device, "gone", "a wheel that is plugged in");
                return b.open();
            };
            b.wheel.hand_stiffness = 10.0;
            check_driver_contract(open, [&] { b.wheel.hand += 0.01; });
            check_unplugged(open, [&] { b.plug.unplugged = true; });
        }
}

TEST_CASE("Wheel: a reversed configuration reverses the torque and keeps the angle") {
    Bench b({.power = 1.0}, {.reversed = true});
    b.run(0.01, [] { return 1.0; });
    CHECK(b.wheel.torque() == doctest::Approx(-1.0).epsilon(0.01));
}

}  // namespace device_wheel_test
