// A station with its threads on the real clock. The tests check order and counts, which do not depend on the
// speed of the machine; soak.cpp tests delays in virtual time.
#include "haptics/station/station.hpp"

#include <doctest/doctest.h>

#include <thread>

#include "haptics/device/virtual_devices.hpp"
#include "tests/station/gloved.hpp"
#include "tests/station/support.hpp"
#include "tests/support/eventually.hpp"
#include "tools/emulate/glove.hpp"

using namespace bolt;
using namespace bolt::station;
using bolt::test::eventually;

namespace {

// A cable to a device, which a test unplugs and plugs in.
struct Cable {
    std::atomic<bool> plugged{true}, hangs{false};
};

class OnCable final : public device::DeviceDriver {
  public:
    OnCable(std::shared_ptr<Cable> cable, std::unique_ptr<device::DeviceDriver> device)
        : cable_(std::move(cable)), device_(std::move(device)) {}
    [[nodiscard]] const device::Description& description() const override { return device_->description(); }
    Result<std::optional<device::Sample>> read(double patience) override {
        while (cable_->hangs) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (!cable_->plugged) return pulled();
        return device_->read(patience);
    }
    Status write(const force::OutputCommand& command) override {
        if (!cable_->plugged) return pulled();
        return device_->write(command);
    }
    static tl::unexpected<Error> pulled() {
        return fail(ErrorCode::no_device, "the puck is not there", "plug it in");
    }

  private:
    std::shared_ptr<Cable> cable_;
    std::unique_ptr<device::DeviceDriver> device_;
};

device::DeviceFactory on_cable(std::shared_ptr<Cable> cable, device::DeviceFactory open) {
    return [cable = std::move(cable),
            open = std::move(open)]() -> Result<std::unique_ptr<device::DeviceDriver>> {
        if (!cable->plugged) return OnCable::pulled();
        auto device = open();
        if (!device) return fail(device.error());
        return std::make_unique<OnCable>(cable, std::move(*device));
    };
}

StationOptions plan_of(device::DeviceFactory mover) {
    StationOptions plan;
    plan.mover = std::move(mover);
    plan.home.position = Vec3(0.0, 0.3, 0.0);
    plan.open_timeout = 60.0;
    plan.device_threads.priority = plan.servo.priority = 0;
    plan.servo.lock_memory = false;
    plan.make_setup = [](const force::OutputLimits& limits, double) { return test::two_joints(limits); };
    return plan;
}

std::string joined_lines(const std::vector<std::string>& messages) {
    std::string all;
    for (const std::string& message : messages) all += message + "\n";
    return all;
}

}  // namespace

TEST_CASE("Station: a puck moves the tool, and every tick can be recorded in order") {
    device::VirtualPuck puck({}, device::steady_timer());
    Result<Station> station = Station::start(plan_of(puck.factory()));
    REQUIRE(station);
    CHECK(station->layout().mover->name == "mouse and keyboard");
    CHECK(station->setup().limits.force == 0.0);
    StationControls controls;
    controls.dead_man = true;
    controls.guided_joint = 1;
    station->set_controls(controls);
    std::uint64_t number = 0, ticks = 0;
    bool in_order = true;
    float height = 0.0F;
    REQUIRE(eventually([&] {
        puck.set_input({Vec3(0, 1, 0), Vec3(0.0), 0});
        for (StationTick tick; station->next_tick(tick); ++ticks) {
            in_order = in_order && tick.number > number;
            number = tick.number;
            height = tick.input.commanded_tool.position[1];
        }
        return height > 0.4F && station->latest_tick().input.dead_man &&
               station->latest_tick().input.guided_joint == 1;
    }));
    CHECK(in_order);
    CHECK(station->lost_ticks() == 0);
    station->stop();
    for (StationTick tick; station->next_tick(tick);) ++ticks;
    CHECK(ticks == station->servo().timing().ticks - 1);  // the last wake-up only found the request to stop
}

TEST_CASE("Station: every command reaches the servo once and in order; a full queue is an error") {
    device::VirtualPuck puck({}, device::steady_timer());
    Result<Station> station = Station::start(plan_of(puck.factory()));
    REQUIRE(station);
    constexpr int rounds = 200;
    int saved = 0;
    const auto read_ticks = [&] {
        for (StationTick tick; station->next_tick(tick);)
            saved += tick.input.checkpoint_action == servo::save_checkpoint ? 1 : 0;
    };
    for (int i = 1; i <= rounds; ++i) {
        const Pose there{Vec3(0.001 * i, 0.4, 0.0), Quat(1, 0, 0, 0)};
        for (const StationCommand& command :
             {StationCommand(SaveCheckpoint{}), StationCommand(PlaceTool{there})})
            REQUIRE(eventually([&] { return station->send(command).has_value(); }));
        read_ticks();
    }
    REQUIRE(eventually([&] {
        read_ticks();
        return saved >= rounds;
    }));
    CHECK(saved == rounds);
    CHECK(glm::distance(station->latest_tick().commanded_tool.position, Vec3(0.001 * rounds, 0.4, 0.0)) <
          1e-9);
    station->stop();
    for (std::size_t i = 0; i < command_queue_capacity; ++i) REQUIRE(station->send(SaveCheckpoint{}));
    const Status full = station->send(SaveCheckpoint{});
    REQUIRE_FALSE(full);
    CHECK(full.error().message().find("the command queue is full") != std::string::npos);
}

TEST_CASE("Station: an unplugged device is reported and stops the tool; it resumes when plugged in") {
    device::VirtualPuck puck({}, device::steady_timer());
    const auto cable = std::make_shared<Cable>();
    Result<Station> station = Station::start(plan_of(on_cable(cable, puck.factory())));
    REQUIRE(station);
    StationControls controls;
    controls.dead_man = true;
    station->set_controls(controls);
    const auto height = [&] {
        puck.set_input({Vec3(0, 1, 0), Vec3(0.0), 0});
        return station->latest_tick().input.commanded_tool.position[1];
    };
    REQUIRE(eventually([&] { return height() > 0.32F; }));
    CHECK(eventually([&] { return height() > 0.32F && station->fault_messages().empty(); }));
    cable->plugged = false;
    REQUIRE(eventually([&] { return station->latest_tick().output.fault == force::Fault::silent; }));
    REQUIRE(eventually(
        [&] { return joined_lines(station->fault_messages()).find("plug it in") != std::string::npos; }));
    REQUIRE(eventually([&] { return station->link_stats().mover.longest_silence > 0.3; }));
    CHECK(station->link_stats().mover.samples > 0);
    CHECK(station->mover_status()->losses == 1);
    const float stands = height();
    for (int i = 0; i < 20; ++i) CHECK(height() == stands);
    cable->plugged = true;
    REQUIRE(eventually([&] { return height() > stands + 0.02F; }));
    REQUIRE(eventually([&] { return station->fault_messages().empty(); }));
    CHECK(station->latest_tick().output.fault == force::Fault::none);
}

TEST_CASE("Station: a driver that hangs is reported, although its thread is blocked") {
    device::VirtualPuck puck({}, device::steady_timer());
    const auto cable = std::make_shared<Cable>();
    Result<Station> station = Station::start(plan_of(on_cable(cable, puck.factory())));
    REQUIRE(station);
    REQUIRE(eventually([&] { return station->fault_messages().empty(); }));
    cable->hangs = true;
    REQUIRE(eventually([&] {
        return joined_lines(station->fault_messages()).find("has not answered for 0.5 s") !=
               std::string::npos;
    }));
    cable->hangs = false;
    REQUIRE(eventually([&] { return station->fault_messages().empty(); }));
}

TEST_CASE("Station: the glove has its own thread, and its problems are reported") {
    auto line = emulate::SerialGlove::start({.sensors = 22}, 0.5);
    REQUIRE(line);
    device::VirtualPuck puck({}, device::steady_timer());
    StationOptions plan = plan_of(puck.factory());
    plan.glove = line->port();
    Result<Station> station = Station::start(std::move(plan));
    REQUIRE(station);
    REQUIRE(station->glove() != nullptr);
    CHECK(station->hand() == nullptr);
    CHECK(station->wheel_status() == nullptr);
    REQUIRE(eventually([&] { return station->glove()->sample().number > 5; }));
    line->stall(true);
    REQUIRE(eventually(
        [&] { return joined_lines(station->fault_messages()).find("glove") != std::string::npos; }));
    REQUIRE(eventually([&] { return station->glove_report()->longest_silence > 0.5; }));
    CHECK(station->glove_report()->frames > 5);
    line->stall(false);
    REQUIRE(eventually([&] { return station->fault_messages().empty(); }));
}

TEST_CASE(
    "Station: a gloved hand grasps the wrench, holds it while the glove is lost, and releases it by "
    "opening") {
    auto line = emulate::SerialGlove::start({.sensors = 22});
    REQUIRE(line);
    line->set_raw(test::raw_open());
    device::VirtualPuck puck({}, device::steady_timer());
    StationOptions plan = plan_of(puck.factory());
    plan.glove = line->port();
    plan.hand = test::hand_at_bar();
    Result<Station> station = Station::start(std::move(plan));
    REQUIRE(station);
    CHECK(station->glove() == nullptr);
    StationControls controls;
    controls.grip = servo::Grip::wrench;  // overridden by the open hand
    station->set_controls(controls);
    const auto grip = [&] { return station->latest_tick().input.grip; };
    REQUIRE(eventually([&] { return station->hand()->has_angles && grip() == servo::Grip::none; }));
    const hand::Skeleton open = station->hand()->finger_joints;
    station->set_controls({});
    line->set_raw(test::raw_closed());
    REQUIRE(eventually([&] { return grip() == servo::Grip::wrench; }));
    REQUIRE(eventually([&] {
        const DisplayedHand& hand = *station->hand();
        return hand.held && glm::length(hand.finger_joints.position[hand::index_tip] -
                                        open.position[hand::index_tip]) > 0.03;
    }));

    line->stall(true);
    REQUIRE(eventually([&] {
        return joined_lines(station->fault_messages()).find("stays in your hand") != std::string::npos;
    }));
    line->set_raw(test::raw_open());  // not received: the glove is lost
    const std::uint64_t then = station->latest_tick().number;
    bool kept = true;
    REQUIRE(eventually([&] {
        for (StationTick tick; station->next_tick(tick);)
            kept = kept && (tick.number < then || tick.input.grip == servo::Grip::wrench);
        return station->latest_tick().number > then + 300;
    }));
    CHECK(kept);
    line->set_raw(test::raw_closed());
    line->stall(false);
    REQUIRE(eventually([&] { return station->fault_messages().empty(); }));
    CHECK(grip() == servo::Grip::wrench);
    line->set_raw(test::raw_open());
    REQUIRE(eventually([&] { return grip() == servo::Grip::none; }));
    CHECK(!station->hand()->held);
}

TEST_CASE("Station: a glove of the wrong side is reported; a gloved hand without a glove is an error") {
    auto line = emulate::SerialGlove::start({.hand = hand::Side::left});
    REQUIRE(line);
    device::VirtualPuck puck({}, device::steady_timer());
    StationOptions plan = plan_of(puck.factory());
    plan.hand = test::hand_at_bar();
    plan.glove = line->port();
    Result<Station> station = Station::start(std::move(plan));
    REQUIRE(station);
    REQUIRE(eventually([&] {
        return joined_lines(station->fault_messages()).find("it is a left glove") != std::string::npos;
    }));
    StationOptions bare = plan_of(puck.factory());
    bare.hand = test::hand_at_bar();
    CHECK_FALSE(Station::start(std::move(bare)));
}

TEST_CASE("Station: a missing or unsuitable device is an error that names the remedy") {
    const auto cable = std::make_shared<Cable>();
    cable->plugged = false;
    StationOptions plan = plan_of(on_cable(cable, {}));
    plan.open_timeout = 0.2;
    const Result<Station> none = Station::start(std::move(plan));
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message().find("plug it in") != std::string::npos);
    CHECK_FALSE(Station::start(plan_of({})));
    const auto state = std::make_shared<test::Written>();
    state->description = test::wheel_of(2.0);
    CHECK_FALSE(Station::start(plan_of(test::opens(state, device::steady_timer()))));
}
