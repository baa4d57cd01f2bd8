#include "haptics/device/space_mouse.hpp"

#include <doctest/doctest.h>

#include <utility>

#include "tools/emulate/hid_device.hpp"
#include "tools/emulate/puck.hpp"

namespace device_space_mouse_test {

using namespace bolt;
using namespace bolt::device;

namespace {

struct Bench {
    explicit Bench(const emulate::EmulatedPuckOptions& options = {}) : puck(options) {
        plug.device = &puck;
        const auto descriptor = parse_report_descriptor(puck.description().descriptor);
        REQUIRE(descriptor);
        auto made = make_space_mouse(std::make_unique<emulate::EmulatedTransport>(plug), *descriptor, "Puck",
                                     "1:2", feel, [this] { return plug.time; });
        REQUIRE(made);
        device = std::move(*made);
    }
    std::optional<Sample> read(double timeout = 0.01) {
        const auto sample = device->read(timeout);
        REQUIRE(sample);
        return *sample;
    }
    // Returns the last sample within `seconds`.
    Sample after(double seconds) {
        std::optional<Sample> last;
        for (const double until = plug.time + seconds; plug.time < until;)
            if (const auto sample = read(0.002)) last = sample;
        REQUIRE(last);
        return *last;
    }

    emulate::EmulatedPuck puck;
    emulate::EmulatedLink plug;
    PuckResponse feel;
    std::unique_ptr<DeviceDriver> device;
};

}  // namespace

TEST_CASE("SpaceMouse: deflection becomes velocity in the device frame, for every report layout") {
    for (const bool in_one : {true, false}) {
        Bench b({.single_report = in_one});
        CHECK(b.device->description().sensing == Sensing::velocity);
        CHECK(b.device->description().limits.force == 0.0);
        CHECK(b.device->description().buttons == 2);
        // 3Dconnexion's z points down and its y towards the user; here y points up and z towards the user.
        const Vec3 ours[] = {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const double way : {1.0, -1.0}) {
                b.puck.deflection = {};
                b.puck.deflection[axis] = way;
                b.puck.deflection[3 + axis] = -way;
                const Sample s = b.after(0.05);
                CHECK(glm::length(s.velocity - way * b.feel.speed * ours[axis]) < 1e-12);
                CHECK(glm::length(s.angular_velocity + way * b.feel.angular_speed * ours[axis]) < 1e-12);
            }
        b.puck.buttons = 2;
        CHECK(b.after(0.05).buttons == 2U);
    }
}

TEST_CASE("SpaceMouse: velocity rises continuously from zero and faster than linearly") {
    const PuckResponse feel;
    double last = -1.0;
    for (double deflection = 0.0; deflection <= 1.0; deflection += 1.0 / 350.0) {
        SixAxisState state;
        state.deflection[0] = deflection;
        const double v = rates_of(state, feel).velocity.x;
        CHECK(v - std::max(last, 0.0) < 0.01 * feel.speed);
        if (deflection > feel.dead_zone + 0.01) CHECK(v > last);
        if (deflection < feel.dead_zone) CHECK(v == 0.0);
        state.deflection[0] = -deflection;
        CHECK(rates_of(state, feel).velocity.x == -v);
        last = v;
    }
}

TEST_CASE(
    "SpaceMouse: motion stops at once on release and after the timeout if the device falls silent; "
    "unplugging is a loss") {
    Bench b;
    b.puck.deflection[0] = 1.0;
    CHECK(b.after(0.05).velocity.x == b.feel.speed);
    b.puck.deflection[0] = 0.0;
    CHECK(b.after(0.009).velocity.x == 0.0);

    b.puck.deflection[0] = 0.5;
    CHECK(b.after(0.05).velocity.x > 0.0);
    b.puck.stalled = true;
    const double stalled = b.plug.time;
    std::optional<Sample> sample;
    while (!(sample = b.read(0.003)) || sample->velocity.x > 0.0) REQUIRE(b.plug.time < stalled + 1.0);
    CHECK(b.plug.time - stalled <= b.feel.report_timeout + 0.001);
    CHECK(b.plug.time - stalled > 0.5 * b.feel.report_timeout);

    // A device at rest returns a sample for each read.
    b.puck.stalled = false;
    b.puck.deflection[0] = 0.0;
    CHECK(b.after(0.05).velocity.x == 0.0);
    for (int i = 0; i < 100; ++i) CHECK(b.read(0.01));

    b.plug.unplugged = true;
    const auto gone = b.device->read(0.01);
    REQUIRE(!gone);
    CHECK(gone.error().lost);
}

TEST_CASE("SpaceMouse: a late reader gets the latest state") {
    Bench b;
    struct Backlog : emulate::EmulatedPuck {
        std::vector<emulate::Bytes> advance(double) override { return std::exchange(waiting, {}); }
        std::vector<emulate::Bytes> waiting;
    } late;
    for (int i = 0; i <= 40; ++i)
        late.waiting.push_back({1, static_cast<std::uint8_t>(i), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0});
    b.plug.device = &late;
    const auto sample = b.read(0.02);
    REQUIRE(sample);
    SixAxisState last;
    last.deflection[0] = 40.0 / 350.0;
    CHECK(sample->velocity.x == rates_of(last, b.feel).velocity.x);
    CHECK(sample->velocity.x > 0.0);
    CHECK(late.waiting.empty());
}

TEST_CASE("SpaceMouse: truncated, foreign or corrupt reports never exceed the top speed") {
    Bench b({.faults = {.truncated = 0.2, .unknown_id = 0.2, .changed = 0.3, .seed = 3}});
    Random random(5);
    int moved = 0;
    for (int i = 0; i < 4000; ++i) {
        for (double& deflection : b.puck.deflection) deflection = random.uniform(-1.0, 1.0);
        const auto sample = b.read(0.008);
        if (!sample) continue;
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(std::abs(sample->velocity[axis]) <= b.feel.speed);
            CHECK(std::abs(sample->angular_velocity[axis]) <= b.feel.angular_speed);
        }
        moved += glm::length(sample->velocity) > 0.0 ? 1 : 0;
    }
    CHECK(moved > 1000);
}

}  // namespace device_space_mouse_test
