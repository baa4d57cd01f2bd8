// Benchmark of the cost of a device to the servo tick: publishing a command and reading the newest sample at
// 1 kHz while each write of the device takes 15 ms. The counters are microseconds: wall_* is elapsed time
// with interruptions, cpu_* the thread's CPU time. The baseline writes to the device directly.
// `plugin_exchange` is the round trip to the process of the first plug-in for arms.
#include <benchmark/benchmark.h>

#include <thread>

#include "haptics/device/device_thread.hpp"
#include "haptics/device/plugin/arm_process.hpp"
#include "haptics/device/plugin_arms.hpp"
#include "tools/bench/harness.hpp"

namespace {

using namespace bolt;
using bench::run_or_skip;
using bench::unwrap;

constexpr double write_duration = 0.015;  // s
constexpr int ticks = 10'000;

// A device with slow writes.
class SlowDevice final : public device::DeviceDriver {
  public:
    SlowDevice() {
        description_.name = "slow";
        description_.renders.fill(true);
    }
    [[nodiscard]] const device::Description& description() const override { return description_; }
    Result<std::optional<device::Sample>> read(double timeout) override {
        timer_.wait(std::min(timeout, 1e-3));
        return device::Sample{};
    }
    Status write(const force::OutputCommand& /*command*/) override {
        timer_.wait(write_duration);
        return {};
    }

  private:
    device::Timer timer_ = device::steady_timer();
    device::Description description_;
};

// Counts the times in bins (limit / 2, limit], limits in powers of two microseconds.
std::string histogram(const std::vector<double>& microseconds) {
    std::string text = "up to us:";
    for (long end = 1; end < 1'000'000; end *= 2) {
        const double low = end > 1 ? 0.5 * static_cast<double>(end) : -1.0;
        const auto n = std::count_if(microseconds.begin(), microseconds.end(),
                                     [&](double t) { return t > low && t <= static_cast<double>(end); });
        if (n > 0) text += " " + std::to_string(end) + ": " + std::to_string(n) + ",";
    }
    text.pop_back();
    return text;
}

template <class Work>
void measure(benchmark::State& state, int count, const Work& work) {
    for (auto _ : state) {
        std::vector<double> wall, cpu;
        auto next = bench::WallClock::now();
        for (int i = 0; i < count; ++i) {
            std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
            const auto start = bench::WallClock::now();
            const double begun = bench::thread_microseconds();
            work(i);
            cpu.push_back(bench::thread_microseconds() - begun);
            wall.push_back(1e3 * bench::milliseconds_since(start));
        }
        for (const auto& [name, share] : {std::pair("p50", 0.5), std::pair("p99", 0.99),
                                          std::pair("p99.9", 0.999), std::pair("max", 1.0)}) {
            state.counters["wall_" + std::string(name)] = bench::quantile(wall, share);
            state.counters["cpu_" + std::string(name)] = bench::quantile(cpu, share);
        }
        state.SetLabel(histogram(wall));
    }
}

void device_through_a_mailbox(benchmark::State& state) {
    run_or_skip(state, [&] {
        device::DeviceThread thread =
            unwrap(device::DeviceThread::start([]() -> Result<std::unique_ptr<device::DeviceDriver>> {
                return std::make_unique<SlowDevice>();
            }));
        unwrap(thread.wait_until_open(10.0));
        measure(state, ticks, [&](int i) {
            thread.command({Vec3(i, 0, 0), Vec3(0.0)}, true);
            device::DeviceSnapshot snapshot = thread.snapshot();
            benchmark::DoNotOptimize(snapshot);
        });
        state.counters["writes"] = static_cast<double>(thread.status().writes);
    });
}

void device_written_directly(benchmark::State& state) {
    run_or_skip(state, [&] {
        SlowDevice slow;
        measure(state, ticks / 20, [&](int i) { unwrap(slow.write({Vec3(i, 0, 0), Vec3(0.0)})); });
    });
}

void plugin_exchange(benchmark::State& state) {
    run_or_skip(state, [&] {
        const auto plugins = device::find_plugins(device::plugin_folders());
        if (plugins.empty()) throw std::runtime_error("no plug-in; expected one in $BOLTWRIGHT_ARM_PLUGINS");
        device::ArmProcess process = unwrap(device::ArmProcess::start(plugins.front()));
        unwrap(process.call(device::PluginCall::open));
        measure(state, ticks, [&](int /*tick*/) {
            unwrap(process.begin_exchange({sizeof(bw_arm_command_v1), 0, {}, {}}));
            auto reply = unwrap(process.finish_exchange(1.0));
            benchmark::DoNotOptimize(reply);
        });
    });
}

BENCHMARK(device_through_a_mailbox)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(device_written_directly)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(plugin_exchange)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
