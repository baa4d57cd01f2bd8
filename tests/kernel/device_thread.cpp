// Devices on their own threads, as in a station, unplugged and replugged while in use.
#include "haptics/device/device_thread.hpp"

#include <chrono>
#include <thread>

#include "tests/kernel/guest.hpp"
#include "tools/emulate/puck.hpp"
#include "tools/emulate/wheel.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

const Vec3 to_the_right{0.0, 0.0, -1.0};

DeviceThread started(const std::string& id, const WheelConfig& rig = {}) {
    auto thread = DeviceThread::start(factory_for(id, {rig}));
    REQUIRE(thread);
    return std::move(*thread);
}

double motor(const emulate::Uhid& plug) {
    double torque = 0.0;
    with<emulate::EmulatedWheel>(plug, [&](emulate::EmulatedWheel& w) { torque = w.torque(); });
    return torque;
}

double time_until(const std::function<bool()>& condition) {
    const double start = steady_seconds();
    CHECK(holds_within(condition));
    return steady_seconds() - start;
}

}  // namespace

TEST_CASE("Kernel, DeviceThread: a replugged puck is reported within 1 s and usable within 2 s") {
    DeviceThread thread = started("256f:c62e");
    CHECK(time_until([&] {
              return thread.status().fault_message.find("no device 256f:c62e") != std::string::npos;
          }) < 1.0);
    for (int round = 0; round < 3; ++round) {
        auto puck = std::make_unique<emulate::EmulatedPuck>();
        puck->deflection[0] = 1.0;
        auto plug = std::make_unique<emulate::Uhid>(attach(std::move(puck)));
        const auto is_read = [&] {
            return thread.snapshot().usable && thread.snapshot().sample.velocity.x > 0.0;
        };
        const double usable = time_until(is_read);
        CHECK(usable < 2.0);
        CHECK(thread.status().fault_message.empty());
        plug.reset();
        const double lost = time_until([&] { return !thread.snapshot().usable; });
        CHECK(lost < 0.02);
        const double reported = time_until([&] { return !thread.status().fault_message.empty(); });
        CHECK(reported < 1.0);
        MESSAGE("usable after " << usable << " s, lost after " << lost * 1e3 << " ms, reported after "
                                << reported * 1e3 << " ms");
        std::this_thread::sleep_for(std::chrono::milliseconds(1500 * round));  // the supervisor backs off
    }
}

TEST_CASE(
    "Kernel, DeviceThread: a wheel has no torque 20 ms after the last command, nor after a replug until a "
    "new command") {
    emulate::EmulatedWheelOptions design;
    WheelConfig rig;
    rig.full_torque = design.full_torque;
    auto plug = std::make_unique<emulate::Uhid>(attach(std::make_unique<emulate::EmulatedWheel>(design)));
    DeviceThread thread = started("1209:ffb0", rig);
    const auto command_for = [&](double seconds, double torque) {
        for (const double until = steady_seconds() + seconds; steady_seconds() < until;) {
            thread.command({.torque = to_the_right * torque}, true);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    };
    for (int round = 0; round < 3; ++round) {
        CHECK(time_until([&] { return thread.snapshot().usable; }) < 2.0);
        CHECK(motor(*plug) == 0.0);
        command_for(0.2, 1.2);
        CHECK(motor(*plug) == doctest::Approx(1.2).epsilon(0.01));
        // The servo thread has stopped.
        const double without = time_until([&] { return motor(*plug) == 0.0; });
        CHECK(without < 0.02);
        MESSAGE("no torque " << without * 1e3 << " ms after the last command");
        command_for(0.1, -1.2);
        CHECK(motor(*plug) == doctest::Approx(-1.2).epsilon(0.01));
        plug.reset();
        const double lost = time_until([&] { return !thread.snapshot().usable; });
        CHECK(lost < 0.02);
        command_for(0.1, 1.0);  // without a device
        plug = std::make_unique<emulate::Uhid>(attach(std::make_unique<emulate::EmulatedWheel>(design)));
    }
    CHECK(time_until([&] { return thread.snapshot().usable; }) < 2.0);
    command_for(0.1, 1.0);
    CHECK(motor(*plug) > 0.9);
    { const DeviceThread closed = std::move(thread); }
    CHECK(time_until([&] { return motor(*plug) == 0.0; }) < 0.02);
}
