// The thread of a device and its mailboxes. These tests check order and counts only, so they do not depend on
// the machine's speed; supervisor.cpp tests the timing in virtual time.
#include "haptics/device/device_thread.hpp"

#include <doctest/doctest.h>

#include <condition_variable>
#include <mutex>

#include "tests/device/support.hpp"
#include "tests/support/eventually.hpp"

using namespace bolt;
using namespace bolt::device;
using bolt::test::eventually;

namespace {

// Lets the test unplug the device and block its writes.
struct Bench {
    std::atomic<bool> plugged{true};
    std::atomic<bool> block_writes{false};   // writes block until release()
    std::atomic<bool> write_blocked{false};  // a write is blocked now
    std::atomic<int> open{0};
    std::mutex mutex;
    std::condition_variable unblocked;
    std::vector<force::OutputCommand> commands;

    std::vector<force::OutputCommand> written() {
        const std::lock_guard lock(mutex);
        return commands;
    }
    void release() {
        const std::lock_guard lock(mutex);
        block_writes = false;
        unblocked.notify_all();
    }
};

class BenchDriver final : public DeviceDriver {
  public:
    explicit BenchDriver(std::shared_ptr<Bench> bench) : bench_(std::move(bench)) { ++bench_->open; }
    BenchDriver(const BenchDriver&) = delete;
    BenchDriver& operator=(const BenchDriver&) = delete;
    ~BenchDriver() override { --bench_->open; }

    [[nodiscard]] const Description& description() const override { return description_; }
    Result<std::optional<Sample>> read(double timeout) override {
        if (!bench_->plugged) return lost();
        timer_.wait(std::min(timeout, 1e-3));
        Sample sample;
        sample.pose.position.x = 1e-6 * static_cast<double>(++count_);
        return sample;
    }
    Status write(const force::OutputCommand& command) override {
        if (!bench_->plugged) return lost();
        std::unique_lock lock(bench_->mutex);
        if (bench_->block_writes) {
            bench_->write_blocked = true;
            bench_->unblocked.wait(lock, [&] { return !bench_->block_writes; });
            bench_->write_blocked = false;
        }
        bench_->commands.push_back(command);
        return {};
    }

  private:
    static tl::unexpected<Error> lost() {
        Error error;
        error.code = ErrorCode::no_device;
        error.what = "the cable is out";
        error.lost = true;
        return fail(error);
    }

    std::shared_ptr<Bench> bench_;
    Description description_ = test::arm();
    Timer timer_ = steady_timer();
    std::uint64_t count_ = 0;
};

DeviceFactory opens(const std::shared_ptr<Bench>& bench) {
    return [bench]() -> Result<std::unique_ptr<DeviceDriver>> {
        if (!bench->plugged) return fail(ErrorCode::no_device, "there is no arm", "a connected arm");
        return std::make_unique<BenchDriver>(bench);
    };
}

}  // namespace

TEST_CASE(
    "DeviceThread: samples arrive in order, commands reach the device, and the destructor releases the "
    "force") {
    const auto bench = std::make_shared<Bench>();
    {
        Result<DeviceThread> device_thread = DeviceThread::start(opens(bench));
        REQUIRE(device_thread);
        const auto description = device_thread->wait_until_open(60.0);
        REQUIRE(description);
        CHECK((*description)->name == "an arm");
        std::uint64_t number = 0;
        bool in_order = true;
        REQUIRE(eventually([&] {
            device_thread->command({Vec3(2, 0, 0), Vec3(0.0)}, true);
            const DeviceSnapshot& current = device_thread->snapshot();
            in_order = in_order && current.number >= number;
            number = current.number;
            const auto written = bench->written();
            return number > 20 && !written.empty() && written.back().force.x == 2.0;
        }));
        CHECK(in_order);
        CHECK(device_thread->snapshot().usable);
        CHECK(device_thread->snapshot().connection_number == 1);
        CHECK(device_thread->snapshot().sample.pose.position.x > 0.0);
    }
    CHECK(bench->written().back().force.x == 0.0);
    CHECK(bench->open == 0);
}

TEST_CASE(
    "DeviceThread: command() returns while the device hangs in a write; afterwards only the latest command "
    "is sent") {
    const auto bench = std::make_shared<Bench>();
    Result<DeviceThread> device_thread = DeviceThread::start(opens(bench));
    REQUIRE(device_thread);
    REQUIRE(device_thread->wait_until_open(60.0));
    REQUIRE(eventually([&] { return bench->written().size() == 1; }));  // the initial zero
    bench->block_writes = true;
    double force = 0.0;
    REQUIRE(eventually([&] {
        device_thread->command({Vec3(force += 1e-3, 0, 0), Vec3(0.0)}, true);
        return bench->write_blocked.load();
    }));
    const std::size_t before = bench->written().size();
    // The write blocks during all of these commands.
    for (int i = 1; i <= 1000; ++i) device_thread->command({Vec3(1 + i, 0, 0), Vec3(0.0)}, true);
    CHECK(bench->write_blocked);
    CHECK(device_thread->snapshot().number > 0);
    CHECK(bench->write_blocked);
    CHECK(bench->written().size() == before);
    bench->release();
    REQUIRE(eventually([&] { return bench->written().size() >= before + 2; }));
    const auto written = bench->written();
    CHECK(written[before].force.x < 1.0);  // the blocked command
    // The latest command follows, or zero if a slow machine let it expire.
    CHECK((written[before + 1].force.x == 20.0 || written[before + 1].force.x == 0.0));
}

TEST_CASE(
    "DeviceThread: after a replug the report names it, the device is usable, and the opening count changes") {
    const auto bench = std::make_shared<Bench>();
    Result<DeviceThread> device_thread = DeviceThread::start(opens(bench));
    REQUIRE(device_thread);
    REQUIRE(eventually([&] { return device_thread->snapshot().number > 5; }));
    bench->plugged = false;
    REQUIRE(eventually([&] { return !device_thread->snapshot().usable; }));
    REQUIRE(eventually(
        [&] { return device_thread->status().fault_message.find("a connected arm") != std::string::npos; }));
    CHECK(device_thread->status().losses == 1);
    CHECK(device_thread->status().state == DeviceState::absent);
    const std::uint64_t at = device_thread->snapshot().number;
    bench->plugged = true;
    REQUIRE(eventually(
        [&] { return device_thread->snapshot().usable && device_thread->snapshot().number > at; }));
    CHECK(device_thread->snapshot().connection_number == 2);
    REQUIRE(eventually([&] { return device_thread->status().fault_message.empty(); }));
}

TEST_CASE("DeviceThread: wait_until_open reports why a missing device does not open") {
    const auto bench = std::make_shared<Bench>();
    bench->plugged = false;
    Result<DeviceThread> device_thread = DeviceThread::start(opens(bench));
    REQUIRE(device_thread);
    REQUIRE(eventually([&] { return device_thread->status().failed_openings > 0; }));
    const auto none = device_thread->wait_until_open(0.0);
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::no_device);
    CHECK(none.error().message() == "there is no arm; expected a connected arm");
}
