// Times to reopen a device and to release its force, and the reports meanwhile, in virtual time.
#include "haptics/device/device_thread.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "engine/base/random.hpp"
#include "haptics/device/virtual_devices.hpp"
#include "tests/device/support.hpp"

namespace device_supervisor_test {

using namespace bolt;
using namespace bolt::device;

namespace {

// A supervisor of a simulated device, and a servo that issues one command per millisecond while
// `sends_commands`.
struct SupervisedDevice {
    explicit SupervisedDevice(Description description = test::arm(),
                              const std::vector<FaultInterval>& faults = {})
        : device({std::move(description), [](double) { return Sample{}; }, std::nullopt, faults},
                 virtual_timer(time)),
          supervisor(device.factory(), virtual_timer(time)) {}

    VirtualTime time;
    ScriptedDevice device;
    DeviceSupervisor supervisor;
    force::OutputCommand command_to_send{Vec3(1, 2, 3), Vec3(0.1, 0, 0)};
    bool sends_commands = true, enabled = true;
    std::uint64_t samples = 0;

    std::optional<Sample> poll_once() {
        const auto sample = supervisor.poll([&] {
            if (sends_commands) number_ = 1 + static_cast<std::uint64_t>(time.now * 1e3);
            return ForceCommand{command_to_send, enabled, number_};
        });
        if (sample) ++samples;
        return sample;
    }
    void run_until(double end) {
        while (time.now < end) poll_once();
    }
    [[nodiscard]] double force() const { return glm::length(device.rendered().force); }
    [[nodiscard]] double torque() const { return glm::length(device.rendered().torque); }

  private:
    std::uint64_t number_ = 0;
};

// Samples once per period on its own clock and keeps the latest sample until it is read. A write takes 0.3
// ms, as in hidraw.
class Periodic final : public DeviceDriver {
  public:
    Periodic(double period, Timer timer) : period_(period), timer_(std::move(timer)) {
        description_ = test::arm();
        description_.rate = 1.0 / period;
    }
    [[nodiscard]] const Description& description() const override { return description_; }
    Result<std::optional<Sample>> read(double timeout) override {
        const double until = timer_.now() + timeout;
        double taken = newest();
        if (taken <= given_ && taken + period_ <= until) timer_.wait((taken += period_) - timer_.now());
        if (taken <= given_) {
            timer_.wait(until - timer_.now());
            return std::nullopt;
        }
        given_ = taken;
        Sample sample;
        sample.time = taken;
        return sample;
    }
    Status write(const force::OutputCommand& /*command*/) override {
        timer_.wait(0.3e-3);
        return {};
    }

  private:
    [[nodiscard]] double newest() const { return std::floor(timer_.now() / period_ + 1e-9) * period_; }

    double period_, given_ = -1.0;
    Timer timer_;
    Description description_;
};

}  // namespace

TEST_CASE("DeviceSupervisor: a sample is returned within one device period, also during writes") {
    for (const double period : {1e-3, 2e-3, 8e-3}) {
        VirtualTime time;
        DeviceSupervisor supervisor(
            [&]() -> Result<std::unique_ptr<DeviceDriver>> {
                return std::make_unique<Periodic>(period, virtual_timer(time));
            },
            virtual_timer(time));
        int samples = 0;
        double oldest = 0.0;
        while (time.now < 2.0) {
            const auto sample = supervisor.poll([&] {
                return ForceCommand{
                    {Vec3(1, 0, 0), Vec3(0.0)}, true, static_cast<std::uint64_t>(time.now * 1e3)};
            });
            if (!sample) continue;
            ++samples;
            oldest = std::max(oldest, time.now - sample->time);
        }
        CHECK(oldest <= period);
        CHECK(samples >= static_cast<int>(1.9 / period));  // no sample is dropped
    }
}

TEST_CASE("DeviceSupervisor: attempts to open back off exponentially, and the reason is reported at once") {
    VirtualTime time;
    std::vector<double> tries;
    DeviceSupervisor supervisor(
        [&]() -> Result<std::unique_ptr<DeviceDriver>> {
            tries.push_back(time.now);
            return fail(ErrorCode::no_device, "no arm", "a connected arm");
        },
        virtual_timer(time));
    const auto none = [] { return ForceCommand{}; };
    CHECK_FALSE(supervisor.poll(none));
    CHECK(supervisor.status().fault_message == "no arm; expected a connected arm");
    CHECK(supervisor.status().state == DeviceState::absent);
    while (time.now < 10.0) CHECK_FALSE(supervisor.poll(none));
    const double pauses[] = {0.05, 0.1, 0.2, 0.4, 0.8, 1.0, 1.0, 1.0};
    REQUIRE(tries.size() > 8);
    CHECK(tries[0] == 0.0);
    for (std::size_t i = 0; i < 8; ++i)
        CHECK(tries[i + 1] - tries[i] == doctest::Approx(pauses[i]).epsilon(0.01));
    CHECK(supervisor.status().failed_openings == tries.size());
}

TEST_CASE("DeviceSupervisor: a device that fails at its first read is not reopened in a busy loop") {
    VirtualTime time;
    const auto state = std::make_shared<test::Written>();
    state->fails_reading = true;
    DeviceSupervisor supervisor(test::opens(state, virtual_timer(time)), virtual_timer(time));
    while (time.now < 10.0) supervisor.poll([] { return ForceCommand{}; });
    CHECK(supervisor.status().openings == supervisor.status().losses);
    CHECK(supervisor.status().openings < 16);
    CHECK(supervisor.status().openings > 8);
}

TEST_CASE("DeviceSupervisor: a replug at any moment is reported within 10 ms and usable within 2 s") {
    Random random(1);
    for (int run = 0; run < 200; ++run) {
        SupervisedDevice supervised;
        supervised.run_until(random.uniform(0.01, 0.5));
        REQUIRE(supervised.supervisor.status().state == DeviceState::usable);
        REQUIRE(supervised.supervisor.status().fault_message.empty());
        const double pulled = supervised.time.now;
        const double back = pulled + random.uniform(0.001, 5.0);
        supervised.device.inject({InjectedFault::unplugged, pulled, back});
        supervised.run_until(pulled + 0.01);
        if (back > pulled + 0.01) {
            CHECK(supervised.supervisor.status().state == DeviceState::absent);
            CHECK(supervised.supervisor.status().fault_message.find("not plugged in") != std::string::npos);
            CHECK(supervised.supervisor.status().losses == 1);
        }
        supervised.run_until(back);
        while (supervised.supervisor.status().state != DeviceState::usable &&
               supervised.time.now < back + 3.0)
            supervised.poll_once();
        CHECK(supervised.time.now <= back + 2.0);
        supervised.poll_once();
        supervised.poll_once();
        CHECK(supervised.force() == doctest::Approx(std::sqrt(14.0)));
        CHECK(supervised.supervisor.status().fault_message.empty());
    }
}

TEST_CASE("DeviceSupervisor: when commands stop, the force is released within 20 ms") {
    Random random(2);
    for (int run = 0; run < 200; ++run) {
        SupervisedDevice supervised;
        supervised.run_until(random.uniform(0.05, 0.2));
        REQUIRE(supervised.force() > 3.0);
        supervised.sends_commands = false;
        const double last = supervised.time.now;
        supervised.run_until(last + 0.010);
        CHECK(supervised.force() > 3.0);  // a late command is no loss yet
        supervised.run_until(last + 0.020);
        CHECK(supervised.force() == 0.0);
        CHECK(supervised.torque() == 0.0);
        CHECK(supervised.supervisor.status().command_timeouts == 1);
        supervised.run_until(last + 0.5);
        CHECK(supervised.supervisor.status().command_timeouts == 1);
        supervised.sends_commands = true;
        supervised.run_until(last + 0.51);
        CHECK(supervised.force() > 3.0);
    }
}

TEST_CASE("DeviceSupervisor: renders no force while disabled, for a NaN command, and after close") {
    SupervisedDevice supervised;
    supervised.run_until(0.1);
    REQUIRE(supervised.force() > 3.0);
    supervised.enabled = false;
    supervised.run_until(0.103);
    CHECK(supervised.force() == 0.0);
    supervised.enabled = true;
    supervised.run_until(0.106);
    REQUIRE(supervised.force() > 3.0);
    supervised.command_to_send.torque.z = std::numeric_limits<double>::quiet_NaN();
    supervised.run_until(0.109);
    CHECK(supervised.force() == 0.0);
    supervised.command_to_send.torque.z = 0.0;
    supervised.run_until(0.112);
    REQUIRE(supervised.force() > 3.0);
    supervised.supervisor.close();
    CHECK(supervised.force() == 0.0);

    VirtualTime time;
    const auto state = std::make_shared<test::Written>();
    {
        DeviceSupervisor supervisor(test::opens(state, virtual_timer(time)), virtual_timer(time));
        std::uint64_t number = 0;
        for (int i = 0; i < 50; ++i)
            supervisor.poll([&] { return ForceCommand{{Vec3(1, 0, 0), Vec3(0.0)}, true, ++number}; });
        REQUIRE(state->commands.back().force.x == 1.0);
    }
    CHECK(state->commands.back().force.x == 0.0);
    CHECK(state->closed == 1);
}

TEST_CASE("DeviceSupervisor: commands older than the opening are never rendered; the first write is zero") {
    VirtualTime time;
    const auto state = std::make_shared<test::Written>();
    DeviceSupervisor supervisor(test::opens(state, virtual_timer(time)), virtual_timer(time));
    for (int i = 0; i < 100; ++i)
        supervisor.poll([] { return ForceCommand{{Vec3(9, 0, 0), Vec3(0.0)}, true, 77}; });
    REQUIRE(state->commands.size() == 1);
    CHECK(state->commands[0].force == Vec3(0.0));
    supervisor.poll([] { return ForceCommand{{Vec3(9, 0, 0), Vec3(0.0)}, true, 78}; });
    REQUIRE(state->commands.size() == 2);
    CHECK(state->commands[1].force == Vec3(9, 0, 0));
    CHECK(supervisor.status().command_timeouts == 0);
}

TEST_CASE("DeviceSupervisor: a command is clamped to the described limits and axes") {
    VirtualTime time;
    const auto state = std::make_shared<test::Written>();
    state->description.renders = {true, true, false, false, false, true};
    state->description.limits.force = 5.0;
    state->description.limits.torque = 0.5;
    DeviceSupervisor supervisor(test::opens(state, virtual_timer(time)), virtual_timer(time));
    supervisor.poll([] { return ForceCommand{}; });
    supervisor.poll([] { return ForceCommand{{Vec3(30, 40, 50), Vec3(1, 1, -2)}, true, 1}; });
    CHECK(glm::length(state->commands.back().force - Vec3(3, 4, 0)) < 1e-12);
    CHECK(glm::length(state->commands.back().torque - Vec3(0, 0, -0.5)) < 1e-12);
}

TEST_CASE("DeviceSupervisor: invalid samples are counted and dropped; many in a row count as silence") {
    SupervisedDevice supervised;
    supervised.run_until(0.1);
    const std::uint64_t before = supervised.samples;
    supervised.device.inject({InjectedFault::not_a_number, 0.1, 0.2});
    supervised.run_until(0.199);
    CHECK(supervised.samples == before);
    CHECK(supervised.supervisor.status().malformed_samples >= 98);
    CHECK(supervised.supervisor.status().state == DeviceState::usable);
    supervised.run_until(0.3);
    CHECK(supervised.samples > before + 90);
    supervised.device.inject({InjectedFault::not_a_number, 0.3, 0.7});
    supervised.run_until(0.6);
    CHECK(supervised.supervisor.status().state == DeviceState::silent);
    CHECK(supervised.supervisor.status().fault_message.find("no valid samples") != std::string::npos);
    supervised.run_until(0.8);
    CHECK(supervised.supervisor.status().state == DeviceState::usable);
    CHECK(supervised.supervisor.status().fault_message.empty());
    CHECK(supervised.supervisor.status().openings == 1);
}

TEST_CASE(
    "DeviceSupervisor: a silent device is reported within 1 s, reopened, and usable within 2 s of its "
    "return") {
    SupervisedDevice supervised;
    supervised.run_until(0.1);
    supervised.device.inject({InjectedFault::silent, 0.1, 4.0});
    supervised.run_until(0.5);
    CHECK(supervised.supervisor.status().state == DeviceState::silent);
    CHECK_FALSE(supervised.supervisor.status().fault_message.empty());
    CHECK(supervised.supervisor.status().openings == 1);
    supervised.run_until(3.9);
    CHECK(supervised.supervisor.status().silence_timeouts >= 2);
    CHECK_FALSE(supervised.supervisor.status().fault_message.empty());
    supervised.run_until(4.0);
    while (supervised.supervisor.status().state != DeviceState::usable && supervised.time.now < 8.0)
        supervised.poll_once();
    CHECK(supervised.time.now < 6.0);
}

TEST_CASE("DeviceSupervisor: devices that are silent at rest may rest indefinitely") {
    for (const Sensing sensing : {Sensing::velocity, Sensing::angle}) {
        Description description = test::arm();
        description.sensing = sensing;
        description.silent_at_rest = sensing == Sensing::angle;
        SupervisedDevice supervised(description, {{InjectedFault::silent, 0.0, 100.0}});
        supervised.run_until(10.0);
        CHECK(supervised.supervisor.status().state == DeviceState::usable);
        CHECK(supervised.supervisor.status().openings == 1);
        CHECK(supervised.supervisor.status().fault_message.empty());
        CHECK(supervised.supervisor.status().samples == 0);
    }
}

TEST_CASE(
    "DeviceSupervisor: while a write takes 15 ms commands are accepted, and only the latest is written "
    "next") {
    VirtualTime time;
    const auto state = std::make_shared<test::Written>();
    state->write_takes = 0.015;
    DeviceSupervisor supervisor(test::opens(state, virtual_timer(time)), virtual_timer(time));
    while (time.now < 1.0)
        supervisor.poll([&] {
            const auto tick = static_cast<std::uint64_t>(time.now * 1e3);
            return ForceCommand{{Vec3(1e-3 * static_cast<double>(tick), 0, 0), Vec3(0.0)}, true, tick};
        });
    REQUIRE(state->commands.size() > 50);
    CHECK(state->commands.size() < 70);
    for (std::size_t i = 1; i < state->commands.size(); ++i)
        CHECK(state->commands[i].force.x == doctest::Approx(state->began[i]).epsilon(1e-2).scale(0.1));
    CHECK(supervisor.status().command_timeouts == 0);
}

}  // namespace device_supervisor_test
