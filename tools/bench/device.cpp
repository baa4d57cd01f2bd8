// What a servo's tick pays for a device: an order given and the newest sample taken, a thousand times a
// second, while the device's own write takes 15 ms each. In microseconds: wall_* of the clock, so with
// whatever the machine did meanwhile, own_* of the thread's own work. The baseline writes to the same device
// itself.
#include <benchmark/benchmark.h>

#include <thread>

#include "haptics/device/line.hpp"
#include "tools/bench/need.hpp"
#include "tools/bench/tick_times.hpp"

namespace {

using namespace bolt;
using bench::guarded;
using bench::need;

constexpr double stall = 0.015;  // s
constexpr int ticks = 10'000;

// A hidraw device that is slow to take what it is told.
class Slow final : public device::Device {
  public:
    Slow() {
        description_.name = "slow";
        description_.renders.fill(true);
    }
    [[nodiscard]] const device::Description& describe() const override { return description_; }
    Result<std::optional<device::Sample>> read(double patience) override {
        timer_.wait(std::min(patience, 1e-3));
        return device::Sample{};
    }
    Status write(const force::OutputCommand& /*command*/) override {
        timer_.wait(stall);
        return {};
    }

  private:
    device::Timer timer_ = device::steady_timer();
    device::Description description_;
};

// How many took longer than half of so many microseconds and not longer than them.
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
        std::vector<double> wall, own;
        auto next = bench::Clock::now();
        for (int i = 0; i < count; ++i) {
            std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
            const auto start = bench::Clock::now();
            const double begun = bench::thread_microseconds();
            work(i);
            own.push_back(bench::thread_microseconds() - begun);
            wall.push_back(1e3 * bench::milliseconds_since(start));
        }
        for (const auto& [name, share] :
             {std::pair("p50", 0.5), std::pair("p99.9", 0.999), std::pair("max", 1.0)}) {
            state.counters["wall_" + std::string(name)] = bench::quantile(wall, share);
            state.counters["own_" + std::string(name)] = bench::quantile(own, share);
        }
        state.SetLabel(histogram(wall));
    }
}

void device_through_a_mailbox(benchmark::State& state) {
    guarded(state, [&] {
        device::Line line = need(device::Line::start(
            []() -> Result<std::unique_ptr<device::Device>> { return std::make_unique<Slow>(); }));
        need(line.await(10.0));
        measure(state, ticks, [&](int i) {
            line.order({Vec3(i, 0, 0), Vec3(0.0)}, true);
            benchmark::DoNotOptimize(line.told());
        });
        state.counters["writes"] = static_cast<double>(line.report().writes);
    });
}

void device_written_directly(benchmark::State& state) {
    guarded(state, [&] {
        Slow slow;
        measure(state, ticks / 20, [&](int i) { need(slow.write({Vec3(i, 0, 0), Vec3(0.0)})); });
    });
}

BENCHMARK(device_through_a_mailbox)->Iterations(1)->Unit(benchmark::kMillisecond);
BENCHMARK(device_written_directly)->Iterations(1)->Unit(benchmark::kMillisecond);

}  // namespace
