// The driver of Haply's Inverse3, on an emulated service.
#include "haptics/device/haply.hpp"

#include <doctest/doctest.h>

#include <atomic>
#include <cstdlib>
#include <thread>

#include "engine/base/steady_seconds.hpp"
#include "haptics/device/arms.hpp"
#include "haptics/device/haply_messages.hpp"
#include "tests/device/driver_contract.hpp"
#include "tests/device/haply_bench.hpp"

namespace device_haply_test {

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;
using emulate::EmulatedHaplyOptions;
using emulate::HaplyFault;
using emulate::HaplyGrip;
using Bench = HaplyBench;

namespace {

constexpr double patience = 60.0;       // s; only a failure waits so long
constexpr double longest_force = 0.02;  // s on the hand after a fault has shown

std::unique_ptr<DeviceDriver> opened(const Bench& bench) {
    auto device = bench.open();
    REQUIRE_MESSAGE(device, (device ? "" : device.error().message()));
    return std::move(*device);
}

// Renders `force` and reads until `done(sample)`; the last sample.
template <class Done>
Sample render_until(DeviceDriver& device, const Vec3& force, const Done& done) {
    Sample last;
    bool reached = false;
    for (const double end = steady_seconds() + patience; !reached && steady_seconds() < end;) {
        REQUIRE(device.write({force, {}}));
        const auto sample = device.read(0.005);
        REQUIRE_MESSAGE(sample, (sample ? "" : sample.error().message()));
        if (!*sample) continue;
        last = **sample;
        reached = done(last);
    }
    CHECK(reached);
    return last;
}

template <class Done>
bool eventually(const Done& done) {
    for (const double end = steady_seconds() + patience; steady_seconds() < end;) {
        if (done()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
}

// Renders a force until the driver reports that the device is lost.
Error render_until_lost(DeviceDriver& device) {
    for (const double end = steady_seconds() + patience; steady_seconds() < end;) {
        if (const Status written = device.write({Vec3(2, 0, 0), {}}); !written) return written.error();
        if (const auto sample = device.read(0.005); !sample) return sample.error();
    }
    return {};
}

}  // namespace

TEST_CASE("Haply: keeps the contract of drivers, with each grip and with messages before 3.5") {
    EmulatedHaplyOptions options;
    for (const HaplyGrip grip : {HaplyGrip::wireless, HaplyGrip::wired, HaplyGrip::none}) {
        for (const std::string version : {"3.5.0.0", "3.4.1.0", ""}) {
            CAPTURE(version);
            options.grip = grip;
            options.version = version;
            Bench bench(options);
            check_driver_contract([&] { return bench.open(); }, [] {});
            CHECK(bench.arm->commands() > 0);
            CHECK(bench.arm->rejected() == 0);
            check_unplugged([&] { return bench.open(); }, [&] { bench.arm.reset(); });
        }
    }
}

TEST_CASE("Haply: the service's frame has x to the right, y forward and z up") {
    for (const bool centred : {false, true}) {
        CAPTURE(centred);
        Bench bench({.centred = centred});
        const auto device = opened(bench);
        const std::array<std::pair<Vec3, Vec3>, 3> axes{
            {{{0.05, 0, 0}, {0.05, 0, 0}}, {{0, 0.05, 0}, {0, 0, -0.05}}, {{0, 0, 0.05}, {0, 0.05, 0}}}};
        for (const auto& axis : axes) {  // theirs, ours
            bench.arm->intend(axis.first);
            render_until(*device, Vec3(0.0),
                         [&](const Sample& s) { return glm::distance(s.pose.position, axis.second) < 1e-4; });
        }
        bench.arm->intend(Vec3(0.0));
        // A force moves the hand in its direction: 3 N against 300 N/m.
        for (const Vec3 force : {Vec3(3, 0, 0), Vec3(0, 3, 0), Vec3(0, 0, 3)})
            render_until(*device, force, [&](const Sample& s) {
                return glm::distance(s.pose.position, force / 300.0) < 1e-3;
            });
    }
}

TEST_CASE("Haply: velocity, orientation and buttons") {
    Bench bench;
    const auto device = opened(bench);
    // A quarter turn about the service's y axis (forward), which is our -z.
    bench.arm->turn(glm::angleAxis(0.5 * pi, Vec3(0, 1, 0)));
    bench.arm->press(5);
    const Sample turned = render_until(*device, Vec3(0.0), [](const Sample& s) { return s.buttons == 5; });
    CHECK(glm::distance(turned.pose.orientation * Vec3(0, 1, 0), Vec3(1, 0, 0)) < 1e-9);
    bench.arm->intend({0, 0, 0.08});
    render_until(*device, Vec3(0.0), [](const Sample& s) { return s.velocity.y > 0.05; });
    CHECK(device->description().buttons == 3);

    Bench wired({.grip = HaplyGrip::wired});
    const auto with_wired = opened(wired);
    wired.arm->press(1);
    render_until(*with_wired, Vec3(0.0), [](const Sample& s) { return s.buttons == 1; });
    CHECK(with_wired->description().buttons == 1);

    Bench none({.grip = HaplyGrip::none});
    const auto without = opened(none);
    CHECK(without->description().buttons == 0);
    CHECK(without->description().remarks.front().find("has no VerseGrip") == 0);
}

TEST_CASE("Haply: renders 10 N at most, no torque, and no force that is not finite") {
    Bench bench;
    const auto device = opened(bench);
    CHECK(device->description().limits.force == 10.0);
    CHECK(device->description().limits.torque == 0.0);
    CHECK(device->description().limits.stiffness == 1000.0);
    render_until(*device, Vec3(0, 100, 0),
                 [&](const Sample&) { return glm::distance(bench.arm->force(), Vec3(0, 0, 10)) < 1e-5; });
    render_until(*device, Vec3(0, NAN, 0), [&](const Sample&) { return bench.arm->force() == Vec3(0.0); });
}

TEST_CASE("Haply: a force that is not repeated becomes zero after 20 ms of the driver's clock") {
    Bench bench;
    // The clock stands still, so the force stays, however slow the computer is.
    std::atomic<double> now{0.0};
    auto frozen = open_haply(bench.service, 0, {[&] { return now.load(); }, steady_timer().wait});
    REQUIRE(frozen);
    REQUIRE((*frozen)->write({Vec3(2, 0, 0), {}}));
    const auto renders = [&] { return bench.arm->force().x > 1.0; };
    now = 0.019;
    CHECK(eventually(renders));
    now = 0.021;
    const auto exchanges = [&](std::uint64_t n) {
        const std::uint64_t before = bench.arm->commands();
        return eventually([&] { return bench.arm->commands() >= before + n; });
    };
    CHECK(exchanges(20));
    CHECK(eventually([&] { return bench.arm->force() == Vec3(0.0); }));
    CHECK(exchanges(20));
    CHECK(bench.arm->force() == Vec3(0.0));
}

TEST_CASE("Haply: a late answer lets the force go, and the device stays open") {
    Bench bench({.command_lifetime = 1e9, .answer_delay = 0.05});
    auto device = open_haply(bench.service, 0, {[] { return 0.0; }, steady_timer().wait});
    REQUIRE(device);
    REQUIRE((*device)->write({Vec3(2, 0, 0), {}}));  // never too old by this clock
    for (int i = 0; i < 3; ++i) {
        CHECK(eventually([&] { return bench.arm->force().x > 1.0; }));
        CHECK(eventually([&] { return bench.arm->force() == Vec3(0.0); }));
    }
    CHECK((*device)->write({}));
}

TEST_CASE("Haply: closing the device releases the force with its last message") {
    Bench bench({.command_lifetime = 1e9});
    auto device = opened(bench);
    render_until(*device, Vec3(4, 0, 0), [&](const Sample&) { return bench.arm->force().x > 3.0; });
    device.reset();
    CHECK(eventually([&] { return bench.arm->force() == Vec3(0.0); }));
    CHECK(bench.open());
}

TEST_CASE("Haply: after every fault the device is lost, names it, and no force is left") {
    const std::array<std::pair<HaplyFault, std::string>, 16> faults{{
        {HaplyFault::close, "127.0.0.1:"},
        {HaplyFault::silence, "the Haply service no longer answers"},
        {HaplyFault::nonsense, "sends a message that is not JSON; expected a JSON object"},
        {HaplyFault::array, "sends array; expected a JSON object"},
        {HaplyFault::huge, "127.0.0.1:"},
        {HaplyFault::null_position, "cursor_position.y is of type null; expected a number"},
        {HaplyFault::text_position, "cursor_position.z is of type string; expected a number"},
        {HaplyFault::no_position, "cursor_position.x is missing; expected a number"},
        {HaplyFault::overflow, "sends a message that is not JSON"},
        {HaplyFault::millimetres, "m; expected 0.6 m at most"},
        {HaplyFault::turn, "orientation has length 0.5; expected a unit quaternion"},
        {HaplyFault::uncalibrated, "Haply Inverse3 049D is not calibrated any more"},
        {HaplyFault::missing, "Haply Inverse3 049D is not connected any more"},
        {HaplyFault::disconnected, "Haply Inverse3 049D was disconnected"},
        {HaplyFault::brake, "has braked: its emergency brake was triggered"},
        {HaplyFault::stall, "has braked: a motor stalled"},
    }};
    for (const auto& expected : faults) {
        const HaplyFault fault = expected.first;
        const std::string& text = expected.second;
        CAPTURE(text);
        Bench bench;
        auto device = opened(bench);
        render_until(*device, Vec3(2, 0, 0), [&](const Sample&) { return bench.arm->force().x > 1.0; });
        bench.arm->set_fault(fault);
        const Error error = render_until_lost(*device);
        CHECK(error.lost);
        CHECK(error.code == ErrorCode::no_device);
        CHECK_MESSAGE(error.message().find(text) != std::string::npos, error.message());
        CHECK(bench.arm->fault_shown());
        CHECK(bench.arm->force_after_fault() <= longest_force);
        CHECK(eventually([&] { return bench.arm->force() == Vec3(0.0); }));
        // Still lost, and the service can be used again without the fault.
        CHECK_FALSE(device->read(0.0));
        CHECK_FALSE(device->write({}));
        device.reset();
        bench.arm->set_fault(HaplyFault::none);
        const auto again = opened(bench);
        render_until(*again, Vec3(2, 0, 0), [&](const Sample&) { return bench.arm->force().x > 1.0; });
    }
}

TEST_CASE("Haply: a service that would keep the last force gets a zero after a fault") {
    for (const HaplyFault fault : {HaplyFault::silence, HaplyFault::nonsense, HaplyFault::null_position,
                                   HaplyFault::millimetres, HaplyFault::uncalibrated}) {
        Bench bench({.command_lifetime = 1e9});
        const auto device = opened(bench);
        render_until(*device, Vec3(2, 0, 0), [&](const Sample&) { return bench.arm->force().x > 1.0; });
        bench.arm->set_fault(fault);
        CHECK(render_until_lost(*device).lost);
        CHECK(eventually([&] { return bench.arm->force() == Vec3(0.0); }));
    }
}

TEST_CASE("Haply: the emulated service measures a force that stays after a fault") {
    Bench bench;
    auto socket = WebSocket::connect(bench.service.states, patience);  // ignores the answers
    REQUIRE(socket);
    bench.arm->set_fault(HaplyFault::null_position);
    CHECK(eventually([&] {
        REQUIRE(socket->send(haply_force_message({"049D", true, Vec3(0.0)}, Vec3(2, 0, 0), false), patience));
        return bench.arm->force_after_fault() > longest_force;
    }));
}

TEST_CASE("Haply: an arm that is not calibrated requests it, when it is listed and when it is opened") {
    const Bench bench({.calibrated = false});
    const auto listed = list_haply(bench.service, patience);
    REQUIRE(listed);
    REQUIRE(listed->size() == 1);
    REQUIRE(listed->front().error);
    const char* text =
        "Haply Inverse3 049D is not calibrated; expected an arm that was placed into its inkwell and "
        "calibrated, as its light shows";
    CHECK(listed->front().error->message() == text);
    CHECK(bench.error_of_opening().message() == text);
    CHECK(preparation_of(bench.error_of_opening()).need == DeviceNeed::inkwell);
    CHECK(bench.arm->commands() == 0);
}

TEST_CASE("Haply: lists the arms of a service") {
    Bench bench;
    const auto listed = list_haply(bench.service, patience);
    REQUIRE(listed);
    REQUIRE(listed->size() == 1);
    CHECK(listed->front().arm == "049D");
    CHECK_FALSE(listed->front().error);
    const auto second = bench.open(1);
    REQUIRE_FALSE(second);
    CHECK(second.error().message().find("the Haply service has no arm 1") == 0);

    const Bench empty({.arm = false});
    const auto none = list_haply(empty.service, patience);
    REQUIRE(none);
    CHECK(none->empty());
    CHECK(empty.error_of_opening().lost);

    // No service: no arm, and no error.
    HaplyService stopped = bench.service;
    bench.arm.reset();
    const auto absent = list_haply(stopped, 0.1);
    REQUIRE(absent);
    CHECK(absent->empty());
    const Error error = bench.error_of_opening();
    CHECK(error.code == ErrorCode::no_device);
    CHECK(error.message().find("the Haply service does not answer: 127.0.0.1:") == 0);
}

TEST_CASE("Haply: another arm and permuted axes are refused, because limits and directions would be wrong") {
    CHECK(Bench({.type = "inverse3x"}).open());
    CHECK(Bench({.type = ""}).open());
    CHECK(Bench({.type = "minverse"}).error_of_opening().message() ==
          "Haply service: device 049D is no Inverse3; expected an Inverse3, whose limits are known");
    const Bench permuted({.basis = "XZY"});
    CHECK(permuted.error_of_opening().message() ==
          "Haply service: device 049D permutes its axes (basis.permutation); expected XYZ");
    const auto listed = list_haply(permuted.service, patience);
    REQUIRE_FALSE(listed);
    CHECK(listed.error().what.find("permutes its axes") != std::string::npos);
}

TEST_CASE("Haply: BOLTWRIGHT_HAPLY names the service") {
    const auto with = [](const char* value) {
        setenv("BOLTWRIGHT_HAPLY", value, 1);
        auto service = haply_service();
        unsetenv("BOLTWRIGHT_HAPLY");
        return service;
    };
    const auto other = with("10.0.0.7:20001");
    REQUIRE(other);
    CHECK(other->states.text() == "10.0.0.7:20001");
    CHECK(other->events.text() == "10.0.0.7:20020");
    CHECK(with("localhost:10001")->states.text() == "127.0.0.1:10001");
    CHECK(with("")->states.text() == "127.0.0.1:10001");
    for (const char* wrong : {"here", "here:", ":10001", "here:0", "here:65530", "here:1x", "here:-1"}) {
        CAPTURE(wrong);
        const auto refused = with(wrong);
        REQUIRE_FALSE(refused);
        CHECK(refused.error().message() == "BOLTWRIGHT_HAPLY is '" + std::string(wrong) +
                                               "'; expected ADDRESS:PORT, for example 127.0.0.1:10001");
    }
}

TEST_CASE("Haply: the vendor's row lists and opens the arm of the service that the environment names") {
    const Bench bench;
    const auto backends = arm_backends();
    const auto row = std::find_if(backends.begin(), backends.end(),
                                  [](const ArmBackend& backend) { return backend.name == "haply"; });
    REQUIRE(row != backends.end());
    setenv("BOLTWRIGHT_HAPLY", bench.service.states.text().c_str(), 1);
    std::vector<ListedDevice> arms;
    CHECK(eventually([&] {  // a listing waits only briefly
        arms = row->list();
        return !arms.empty();
    }));
    REQUIRE(arms.size() == 1);
    CHECK(arms.front().id == "haply:0");
    CHECK(arms.front().name == "Haply Inverse3 049D");
    CHECK(arms.front().kind == DeviceKind::arm);
    const auto device = row->open(arms.front(), {});
    setenv("BOLTWRIGHT_HAPLY", "nowhere", 1);
    const auto unusable = row->list();
    unsetenv("BOLTWRIGHT_HAPLY");
    REQUIRE(device);
    CHECK((*device)->description().id == "haply:0");
    REQUIRE(unusable.size() == 1);
    CHECK(unusable.front().error);
}

}  // namespace device_haply_test
