// The whole tick (contact, nut and joint, guiding, coupling, output stage) of 12 joints on the ZQ350, over
// ten minutes of a simulated arm in contact. The counters are microseconds of CPU time. p50 … max: of the
// ticks of one run; own_*: of the least time of each tick in five runs, which excludes interruptions. step,
// step_torque: the greatest change in a millisecond, as a share of the device's limit.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>

#include "tools/bench/need.hpp"
#include "tools/bench/servo_path.hpp"
#include "tools/bench/tick_times.hpp"

namespace {

using namespace bolt;
using bench::guarded;
using bench::need;

constexpr int rounds = 5;

struct Felt {
    std::size_t ticks = 0, touching = 0, engaged = 0, faults = 0;
    double step = 0.0, torque_step = 0.0;  // N, N·m in a millisecond

    explicit Felt(double dt) : millisecond_(static_cast<std::size_t>(std::lround(1e-3 / dt))) {}

    void add(const servo::Output& now) {
        touching += now.touched.is_none() ? 0U : 1U;
        engaged += now.joint >= 0 ? 1U : 0U;
        faults += now.fault != force::Fault::none ? 1U : 0U;
        force::OutputCommand& before = millisecond_[ticks % millisecond_.size()];
        step = std::max(step, glm::length(now.force - before.force));
        torque_step = std::max(torque_step, glm::length(now.torque - before.torque));
        before = {now.force, now.torque};
        ++ticks;
    }

  private:
    std::vector<force::OutputCommand> millisecond_;
};

void servo_tick(benchmark::State& state, const bench::Device& device, double seconds, bool touches) {
    guarded(state, [&] {
        bench::Servo servo = need(bench::make_servo(device));
        const std::vector<servo::Input> inputs = bench::make_path(servo, device, seconds, 1);
        for (auto _ : state) {
            std::vector<double> first(inputs.size()), least(inputs.size(), 1e9);
            Felt felt(device.dt);
            servo::Output last;
            for (int round = 0; round < rounds; ++round) {
                bench::restart(servo);
                std::optional<servo::ToolContact> apart;
                if (!touches) apart = std::exchange(servo.state.tool_contact, std::nullopt);
                felt = Felt(device.dt);
                servo::Output before;
                for (std::size_t i = 0; i < inputs.size(); ++i) {
                    const double start = bench::thread_microseconds();
                    const servo::Output output = servo::tick(servo.setup, servo.state, inputs[i]);
                    const double took = bench::thread_microseconds() - start;
                    if (round == 0) first[i] = took;
                    least[i] = std::min(least[i], took);
                    felt.add(output);
                    before = output;
                }
                if (round > 0 && (before.force != last.force || before.tool.position != last.tool.position))
                    throw std::runtime_error("the same inputs felt otherwise");
                last = before;
                if (!touches) servo.state.tool_contact = std::move(apart);
            }
            for (const auto& [name, share] : {std::pair("p50", 0.5), std::pair("p99", 0.99),
                                              std::pair("p99.9", 0.999), std::pair("max", 1.0)}) {
                state.counters[name] = bench::quantile(first, share);
                state.counters["own_" + std::string(name)] = bench::quantile(least, share);
            }
            const auto of_all = [&](std::size_t count) {
                return static_cast<double>(count) / static_cast<double>(felt.ticks);
            };
            state.counters["touching"] = of_all(felt.touching);
            state.counters["engaged"] = of_all(felt.engaged);
            state.counters["faults"] = of_all(felt.faults);
            state.counters["step"] = felt.step / servo.setup.limits.force;
            if (servo.setup.limits.torque > 0.0)
                state.counters["step_torque"] = felt.torque_step / servo.setup.limits.torque;
            // The slowest by CPU time.
            std::vector<std::size_t> order(inputs.size());
            for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
            std::partial_sort(order.begin(), order.begin() + 1, order.end(),
                              [&](std::size_t a, std::size_t b) { return least[a] > least[b]; });
            state.SetLabel(std::to_string(inputs.size()) + " ticks, the slowest by its own work " +
                           std::to_string(order[0]));
        }
    });
}

#define SERVO_TICK(name, ...) \
    BENCHMARK_CAPTURE(servo_tick, name, __VA_ARGS__)->Iterations(1)->Unit(benchmark::kMillisecond)

SERVO_TICK(at_1_kHz, bench::Device{}, 600.0, true);
// Baseline: the same hand without obstacles.
SERVO_TICK(at_1_kHz_without_contact, bench::Device{}, 600.0, false);
SERVO_TICK(at_4_kHz_encoder_27_um, (bench::Device{.dt = 0.25e-3, .encoder = 27e-6}), 120.0, true);
SERVO_TICK(at_1_kHz_force_at_the_grip, (bench::Device{.renders_torque = false}), 120.0, true);

}  // namespace
