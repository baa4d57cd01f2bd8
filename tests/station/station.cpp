// A station with its threads on the real clock: order and counts, on a machine of any speed. How soon things
// happen is tested in virtual time (soak.cpp).
#include "haptics/station/station.hpp"

#include <doctest/doctest.h>

#include <thread>

#include "haptics/device/puck.hpp"
#include "tests/station/gloved.hpp"
#include "tests/station/support.hpp"
#include "tests/support/eventually.hpp"
#include "tools/emulate/glove_line.hpp"

using namespace bolt;
using namespace bolt::station;
using bolt::test::eventually;

namespace {

// A cable to a device that a test pulls and puts back.
struct Cable {
    std::atomic<bool> plugged{true}, hangs{false};
};

class OnCable final : public device::Device {
  public:
    OnCable(std::shared_ptr<Cable> cable, std::unique_ptr<device::Device> device)
        : cable_(std::move(cable)), device_(std::move(device)) {}
    [[nodiscard]] const device::Description& describe() const override { return device_->describe(); }
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
    std::unique_ptr<device::Device> device_;
};

device::Open on_cable(std::shared_ptr<Cable> cable, device::Open open) {
    return [cable = std::move(cable), open = std::move(open)]() -> Result<std::unique_ptr<device::Device>> {
        if (!cable->plugged) return OnCable::pulled();
        auto device = open();
        if (!device) return fail(device.error());
        return std::make_unique<OnCable>(cable, std::move(*device));
    };
}

Plan plan_of(device::Open mover) {
    Plan plan;
    plan.mover = std::move(mover);
    plan.home.position = Vec3(0.0, 0.3, 0.0);
    plan.patience = 60.0;
    plan.line.priority = plan.servo.priority = 0;
    plan.servo.lock_memory = false;
    plan.setup = [](const force::OutputLimits& limits, double) { return test::two_joints(limits); };
    return plan;
}

std::string words(const std::vector<std::string>& troubles) {
    std::string all;
    for (const std::string& trouble : troubles) all += trouble + "\n";
    return all;
}

}  // namespace

TEST_CASE("a puck moves the tool; every tick is there to be recorded, in order") {
    device::Puck puck({}, device::steady_timer());
    Result<Station> station = Station::start(plan_of(puck.open()));
    REQUIRE(station);
    CHECK(station->layout().mover->name == "mouse and keyboard");
    CHECK(station->setup().limits.force == 0.0);
    Wishes wishes;
    wishes.held = true;
    wishes.guide = 1;
    station->wish(wishes);
    std::uint64_t number = 0, ticks = 0;
    bool in_order = true;
    float height = 0.0F;
    REQUIRE(eventually([&] {
        puck.put({Vec3(0, 1, 0), Vec3(0.0), 0});
        for (Ticked tick; station->next(tick); ++ticks) {
            in_order = in_order && tick.number > number;
            number = tick.number;
            height = tick.input.device.position[1];
        }
        return height > 0.4F && station->newest().input.enabled && station->newest().input.guide == 1;
    }));
    CHECK(in_order);
    CHECK(station->lost() == 0);
    station->stop();
    for (Ticked tick; station->next(tick);) ++ticks;
    CHECK(ticks == station->servo().timing().ticks - 1);  // the last turn only saw that it was to stop
}

TEST_CASE("a cable pulled at work is said, lets the tool stand, and all goes on when it is back") {
    device::Puck puck({}, device::steady_timer());
    const auto cable = std::make_shared<Cable>();
    Result<Station> station = Station::start(plan_of(on_cable(cable, puck.open())));
    REQUIRE(station);
    Wishes wishes;
    wishes.held = true;
    station->wish(wishes);
    const auto height = [&] {
        puck.put({Vec3(0, 1, 0), Vec3(0.0), 0});
        return station->newest().input.device.position[1];
    };
    REQUIRE(eventually([&] { return height() > 0.32F; }));
    CHECK(eventually([&] { return height() > 0.32F && station->troubles().empty(); }));
    cable->plugged = false;
    REQUIRE(eventually([&] { return station->newest().output.fault == force::Fault::silent; }));
    REQUIRE(eventually([&] { return words(station->troubles()).find("plug it in") != std::string::npos; }));
    REQUIRE(eventually([&] { return station->passed().mover.longest_silence > 0.3; }));
    CHECK(station->passed().mover.samples > 0);
    CHECK(station->mover()->losses == 1);
    const float stands = height();
    for (int i = 0; i < 20; ++i) CHECK(height() == stands);
    cable->plugged = true;
    REQUIRE(eventually([&] { return height() > stands + 0.02F; }));
    REQUIRE(eventually([&] { return station->troubles().empty(); }));
    CHECK(station->newest().output.fault == force::Fault::none);
}

TEST_CASE("a device whose driver does not come back is said, though its line cannot") {
    device::Puck puck({}, device::steady_timer());
    const auto cable = std::make_shared<Cable>();
    Result<Station> station = Station::start(plan_of(on_cable(cable, puck.open())));
    REQUIRE(station);
    REQUIRE(eventually([&] { return station->troubles().empty(); }));
    cable->hangs = true;
    REQUIRE(
        eventually([&] { return words(station->troubles()).find("hangs: unplug it") != std::string::npos; }));
    cable->hangs = false;
    REQUIRE(eventually([&] { return station->troubles().empty(); }));
}

TEST_CASE("a station has a glove on a line of its own, and says what is wrong with it") {
    auto line = emulate::GloveLine::start({.sensors = 22}, 0.5);
    REQUIRE(line);
    device::Puck puck({}, device::steady_timer());
    Plan plan = plan_of(puck.open());
    plan.glove = line->port();
    Result<Station> station = Station::start(std::move(plan));
    REQUIRE(station);
    REQUIRE(station->glove() != nullptr);
    CHECK(station->hand() == nullptr);
    CHECK(station->wheel() == nullptr);
    REQUIRE(eventually([&] { return station->glove()->sample().number > 5; }));
    line->stall(true);
    REQUIRE(eventually([&] { return words(station->troubles()).find("glove") != std::string::npos; }));
    REQUIRE(eventually([&] { return station->gloved()->longest_silence > 0.5; }));
    CHECK(station->gloved()->frames > 5);
    line->stall(false);
    REQUIRE(eventually([&] { return station->troubles().empty(); }));
}

TEST_CASE(
    "a gloved hand at a station takes the wrench, keeps it while the glove is gone, lets it go by opening") {
    auto line = emulate::GloveLine::start({.sensors = 22});
    REQUIRE(line);
    line->show(test::raw_open());
    device::Puck puck({}, device::steady_timer());
    Plan plan = plan_of(puck.open());
    plan.glove = line->port();
    plan.hand = test::hand_at_bar();
    Result<Station> station = Station::start(std::move(plan));
    REQUIRE(station);
    CHECK(station->glove() == nullptr);
    Wishes wishes;
    wishes.grip = servo::Grip::wrench;  // does not count: the hand is open
    station->wish(wishes);
    const auto grip = [&] { return station->newest().input.grip; };
    REQUIRE(eventually([&] { return station->hand()->any && grip() == servo::Grip::none; }));
    const hand::Skeleton open = station->hand()->joints;
    station->wish({});
    line->show(test::raw_closed());
    REQUIRE(eventually([&] { return grip() == servo::Grip::wrench; }));
    REQUIRE(eventually([&] {
        const ShownHand& hand = *station->hand();
        return hand.held &&
               glm::length(hand.joints.position[hand::index_tip] - open.position[hand::index_tip]) > 0.03;
    }));

    line->stall(true);
    REQUIRE(eventually(
        [&] { return words(station->troubles()).find("stays in your hand") != std::string::npos; }));
    line->show(test::raw_open());  // nobody sees that
    const std::uint64_t then = station->newest().number;
    bool kept = true;
    REQUIRE(eventually([&] {
        for (Ticked tick; station->next(tick);)
            kept = kept && (tick.number < then || tick.input.grip == servo::Grip::wrench);
        return station->newest().number > then + 300;
    }));
    CHECK(kept);
    line->show(test::raw_closed());
    line->stall(false);
    REQUIRE(eventually([&] { return station->troubles().empty(); }));
    CHECK(grip() == servo::Grip::wrench);
    line->show(test::raw_open());
    REQUIRE(eventually([&] { return grip() == servo::Grip::none; }));
    CHECK(!station->hand()->held);
}

TEST_CASE("a glove of the other hand than the one that wears it is said; a hand without a glove is none") {
    auto line = emulate::GloveLine::start({.hand = glove::Hand::left});
    REQUIRE(line);
    device::Puck puck({}, device::steady_timer());
    Plan plan = plan_of(puck.open());
    plan.hand = test::hand_at_bar();
    plan.glove = line->port();
    Result<Station> station = Station::start(std::move(plan));
    REQUIRE(station);
    REQUIRE(
        eventually([&] { return words(station->troubles()).find("is a left one") != std::string::npos; }));
    Plan bare = plan_of(puck.open());
    bare.hand = test::hand_at_bar();
    CHECK_FALSE(Station::start(std::move(bare)));
}

TEST_CASE("a station whose device is not there, or is none that moves a tool, does not begin, and says why") {
    const auto cable = std::make_shared<Cable>();
    cable->plugged = false;
    Plan plan = plan_of(on_cable(cable, {}));
    plan.patience = 0.2;
    const Result<Station> none = Station::start(std::move(plan));
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message().find("plug it in") != std::string::npos);
    CHECK_FALSE(Station::start(plan_of({})));
    const auto state = std::make_shared<test::Written>();
    state->description = test::wheel_of(2.0);
    CHECK_FALSE(Station::start(plan_of(test::opens(state, device::steady_timer()))));
}
