// The SpaceMouse driver on a real kernel.
#include "tools/emulate/puck.hpp"

#include "tests/kernel/guest.hpp"

using namespace bolt;
using namespace bolt::device;
using namespace bolt::test;

namespace {

// The last sample within `seconds`.
Sample last_sample(DeviceDriver& device, double seconds) {
    std::optional<Sample> last;
    for (const double until = steady_seconds() + seconds; steady_seconds() < until;) {
        const auto sample = device.read(0.01);
        REQUIRE(sample);
        if (*sample) last = *sample;
    }
    REQUIRE(last);
    return *last;
}

}  // namespace

TEST_CASE("Kernel: without devices the list is empty") {
    CHECK(list_devices(true).empty());
    CHECK(!factory_for("256f:c62e")());
}

TEST_CASE("Kernel: a SpaceMouse is found, identified and read") {
    const auto plug =
        attach(std::make_unique<emulate::EmulatedPuck>(emulate::EmulatedPuckOptions{.serial = "S1"}));
    const ListedDevice l = wait_for_device("256f:c62e:S1");
    CHECK(l.kind == DeviceKind::puck);
    CHECK(l.name == "Emulated SpaceMouse");
    CHECK(l.path.starts_with("/dev/hidraw"));
    REQUIRE_MESSAGE(!l.error, (l.error ? l.error->message() : ""));
    auto device = factory_for(l.id)();
    REQUIRE_MESSAGE(device, (device ? "" : device.error().message()));
    CHECK((*device)->description().sensing == Sensing::velocity);
    with<emulate::EmulatedPuck>(
        plug, [](emulate::EmulatedPuck& p) { p.deflection = {1.0, 0.0, 0.0, 0.0, 0.0, -1.0}; });
    const Sample pushed = last_sample(**device, 0.1);
    CHECK(pushed.velocity.x == doctest::Approx(PuckResponse{}.speed));
    CHECK(pushed.angular_velocity.y == doctest::Approx(PuckResponse{}.angular_speed));
    with<emulate::EmulatedPuck>(plug, [](emulate::EmulatedPuck& p) {
        p.deflection = {};
        p.buttons = 1;
    });
    const Sample rests = last_sample(**device, 0.1);
    CHECK(rests.velocity == Vec3(0.0));
    CHECK(rests.buttons == 1U);
}

TEST_CASE("Kernel: unplugging while reading is a loss at once; after a replug it opens within 2 s") {
    auto plug = std::make_unique<emulate::Uhid>(attach(std::make_unique<emulate::EmulatedPuck>()));
    const std::string id = wait_for_device("256f:c62e").id;
    const DeviceFactory open = factory_for(id);
    for (int round = 0; round < 5; ++round) {
        auto device = open();
        REQUIRE_MESSAGE(device, (device ? "" : device.error().message()));
        with<emulate::EmulatedPuck>(*plug, [](emulate::EmulatedPuck& p) { p.deflection[0] = 0.5; });
        CHECK(last_sample(**device, 0.05).velocity.x > 0.0);

        plug.reset();
        const double unplugged = steady_seconds();
        const auto lost = [&] {
            const auto sample = (*device)->read(0.005);
            if (!sample) CHECK(sample.error().lost);
            return !sample;
        };
        CHECK(holds_within(lost));
        const double took = steady_seconds() - unplugged;
        CHECK(took < 0.02);
        device = fail(ErrorCode::failed, "closed", "open");
        const auto gone = open();
        REQUIRE(!gone);
        CHECK(gone.error().lost);

        plug = std::make_unique<emulate::Uhid>(attach(std::make_unique<emulate::EmulatedPuck>()));
        const double again = steady_seconds();
        CHECK(holds_within([&] { return open().has_value(); }));
        const double usable = steady_seconds() - again;
        CHECK(usable < 2.0);
        MESSAGE("loss reported after " << took * 1e3 << " ms, usable " << usable * 1e3
                                       << " ms after plugging in");
    }
}

TEST_CASE("Kernel: two identical pucks have different ids") {
    const auto one = attach(std::make_unique<emulate::EmulatedPuck>());
    wait_for_device("256f:c62e");
    const auto two = attach(std::make_unique<emulate::EmulatedPuck>());
    wait_for_device("256f:c62e#2");
    auto first = factory_for("256f:c62e")(), second = factory_for("256f:c62e#2")();
    REQUIRE(first);
    REQUIRE(second);
    with<emulate::EmulatedPuck>(one, [](emulate::EmulatedPuck& p) { p.deflection[0] = 1.0; });
    CHECK(last_sample(**first, 0.05).velocity.x > 0.0);
    CHECK(last_sample(**second, 0.05).velocity.x == 0.0);
}

TEST_CASE("Kernel: corrupt reports do not stop a puck") {
    const auto plug = attach(std::make_unique<emulate::EmulatedPuck>(emulate::EmulatedPuckOptions{
        .faults = {.truncated = 0.3, .unknown_id = 0.2, .changed = 0.0, .seed = 2}}));
    auto device = factory_for(wait_for_device("256f:c62e").id)();
    REQUIRE(device);
    with<emulate::EmulatedPuck>(plug, [](emulate::EmulatedPuck& p) { p.deflection[0] = 1.0; });
    CHECK(last_sample(**device, 0.5).velocity.x == doctest::Approx(PuckResponse{}.speed));
}
