// The drivers of wheels and boards on a real kernel.
#include "tools/emulate/wheel.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "tests/kernel/guest.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

struct WheelFixture {
    explicit WheelFixture(const emulate::EmulatedWheelOptions& design)
        : plug(attach(std::make_unique<emulate::EmulatedWheel>(design))),
          found(wait_for_device(design.board ? "1209:ffb0" : "1234:5678")) {
        WheelConfig config;
        config.full_torque = design.full_torque;
        config.range = to_radians(design.degrees);
        auto opened = factory_for(found.id, {config})();
        REQUIRE_MESSAGE(opened, (opened ? "" : opened.error().message()));
        device = std::move(*opened);
    }
    // Reads samples and writes `torque()`, N·m, for `seconds`.
    template <class F>
    void run(double seconds, const F& torque) {
        for (const double until = steady_seconds() + seconds; steady_seconds() < until;) {
            const auto sample = device->read(0.002);
            REQUIRE_MESSAGE(sample, (sample ? "" : sample.error().message()));
            if (*sample) last = **sample;
            const Status written = device->write({.torque = device->description().axis * torque()});
            REQUIRE_MESSAGE(written, (written ? "" : written.error().message()));
        }
    }
    // The torque of the emulated motor, N·m.
    double motor() const {
        double torque = 0.0;
        with<emulate::EmulatedWheel>(plug, [&](emulate::EmulatedWheel& w) { torque = w.torque(); });
        return torque;
    }

    emulate::Uhid plug;
    ListedDevice found;
    std::unique_ptr<DeviceDriver> device;
    Sample last;
};

}  // namespace

TEST_CASE("Kernel: a wheel is found and renders the written torque") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        WheelFixture b({.board = board});
        CHECK(b.found.kind == (board ? DeviceKind::open_ffboard : DeviceKind::wheel));
        CHECK(b.device->description().limits.torque == doctest::Approx(2.0));
        with<emulate::EmulatedWheel>(b.plug, [](emulate::EmulatedWheel& w) { w.hand_stiffness = 10.0; });
        for (const double torque : {1.0, -1.5}) {
            b.run(0.7, [&] { return torque; });
            CHECK(b.motor() == doctest::Approx(torque).epsilon(0.01));
            CHECK(b.last.angle == doctest::Approx(0.1 * torque).epsilon(0.05));
        }
        b.device.reset();
        const auto is_quiet = [&] { return b.motor() == 0.0; };
        CHECK(holds_within(is_quiet, 0.1));
    }
}

TEST_CASE("Kernel: a spring rendered through hidraw rests at static equilibrium") {
    WheelFixture b({});
    with<emulate::EmulatedWheel>(b.plug, [](emulate::EmulatedWheel& w) {
        w.hand_stiffness = 5.0;
        w.hand = 0.4;
    });
    b.run(2.0, [&] { return 5.0 * (0.0 - b.last.angle); });
    CHECK(b.last.angle == doctest::Approx(0.2).epsilon(0.03));
}

TEST_CASE(
    "Kernel: a wheel unplugged under torque is lost, closes without hanging, and has no torque after the "
    "replug") {
    auto b = std::make_unique<WheelFixture>(emulate::EmulatedWheelOptions{});
    b->run(0.1, [] { return 1.5; });
    CHECK(b->motor() == doctest::Approx(1.5).epsilon(0.01));
    b->plug =
        attach(std::make_unique<emulate::EmulatedWheel>(emulate::EmulatedWheelOptions{.serial = "again"}));
    const auto lost = [&] {
        return !b->device->write({.torque = {0.0, 0.0, -1.0}}) || !b->device->read(0.002);
    };
    CHECK(holds_within(lost, 0.1));
    b->device.reset();
    auto again = factory_for(wait_for_device("1209:ffb0:again").id)();
    REQUIRE_MESSAGE(again, (again ? "" : again.error().message()));
    CHECK(b->motor() == 0.0);
    REQUIRE((*again)->write({.torque = {0.0, 0.0, -1.0}}));
    CHECK(holds_within([&] { return b->motor() > 0.0; }, 0.1));
}

TEST_CASE("Kernel: the force outlives a killed program by one second at most") {
    for (const bool board : {true, false}) {
        CAPTURE(board);
        WheelFixture b({.board = board});
        b.device.reset();
        const pid_t child = fork();
        if (child == 0) {
            auto device = factory_for(b.found.id)();
            while (device) static_cast<void>((*device)->write({.torque = {0.0, 0.0, -1.0}}));
            _exit(1);
        }
        CHECK(holds_within([&] { return b.motor() > 0.1; }));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        CHECK(b.motor() > 0.1);
        CHECK(holds_within([&] { return b.motor() == 0.0; }, 1.01));
    }
}

TEST_CASE("Kernel: a mute board times out") {
    auto dead = std::make_unique<emulate::EmulatedWheel>();
    dead->stalled = true;
    const auto plug = attach(std::move(dead));
    const std::string id = wait_for_device("1209:ffb0").id;
    const double begun = steady_seconds();
    const auto device = factory_for(id)();
    REQUIRE(!device);
    CHECK(device.error().message().find("does not report") != std::string::npos);
    CHECK(steady_seconds() - begun < 2.0);
}
