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
    auto line = DeviceThread::start(factory_for(id, rig));
    REQUIRE(line);
    return std::move(*line);
}

double motor(const emulate::Uhid& plug) {
    double torque = 0.0;
    with<emulate::Wheel>(plug, [&](emulate::Wheel& w) { torque = w.torque(); });
    return torque;
}

double took(const std::function<bool()>& so) {
    const double begun = steady_seconds();
    CHECK(becomes(so));
    return steady_seconds() - begun;
}

}  // namespace

TEST_CASE("Kernel, DeviceThread: a replugged puck is reported within 1 s and usable within 2 s") {
    DeviceThread line = started("256f:c62e");
    CHECK(took([&] { return line.report().trouble.find("no device 256f:c62e") != std::string::npos; }) < 1.0);
    for (int round = 0; round < 3; ++round) {
        auto puck = std::make_unique<emulate::Puck>();
        puck->share[0] = 1.0;
        auto plug = std::make_unique<emulate::Uhid>(plugged(std::move(puck)));
        const auto is_read = [&] {
            return line.snapshot().usable && line.snapshot().sample.velocity.x > 0.0;
        };
        const double usable = took(is_read);
        CHECK(usable < 2.0);
        CHECK(line.report().trouble.empty());
        plug.reset();
        const double over = took([&] { return !line.snapshot().usable; });
        CHECK(over < 0.02);
        const double said = took([&] { return !line.report().trouble.empty(); });
        CHECK(said < 1.0);
        MESSAGE("usable after " << usable << " s, over after " << over * 1e3 << " ms, said after "
                                << said * 1e3 << " ms");
        std::this_thread::sleep_for(std::chrono::milliseconds(1500 * round));  // the supervisor backs off
    }
}

TEST_CASE(
    "Kernel, DeviceThread: a wheel has no torque 20 ms after the last command, nor after a replug until a "
    "new command") {
    emulate::WheelOptions design;
    WheelConfig rig;
    rig.full_torque = design.full_torque;
    auto plug = std::make_unique<emulate::Uhid>(plugged(std::make_unique<emulate::Wheel>(design)));
    DeviceThread line = started("1209:ffb0", rig);
    const auto order_for = [&](double seconds, double torque) {
        for (const double until = steady_seconds() + seconds; steady_seconds() < until;) {
            line.command({.torque = to_the_right * torque}, true);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    };
    for (int round = 0; round < 3; ++round) {
        CHECK(took([&] { return line.snapshot().usable; }) < 2.0);
        CHECK(motor(*plug) == 0.0);
        order_for(0.2, 1.2);
        CHECK(motor(*plug) == doctest::Approx(1.2).epsilon(0.01));
        // The servo thread has stopped.
        const double without = took([&] { return motor(*plug) == 0.0; });
        CHECK(without < 0.02);
        MESSAGE("no torque " << without * 1e3 << " ms after the last order");
        order_for(0.1, -1.2);
        CHECK(motor(*plug) == doctest::Approx(-1.2).epsilon(0.01));
        plug.reset();
        const double over = took([&] { return !line.snapshot().usable; });
        CHECK(over < 0.02);
        order_for(0.1, 1.0);  // to nobody
        plug = std::make_unique<emulate::Uhid>(plugged(std::make_unique<emulate::Wheel>(design)));
    }
    CHECK(took([&] { return line.snapshot().usable; }) < 2.0);
    order_for(0.1, 1.0);
    CHECK(motor(*plug) > 0.9);
    { const DeviceThread closed = std::move(line); }
    CHECK(took([&] { return motor(*plug) == 0.0; }) < 0.02);
}
