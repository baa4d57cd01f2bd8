// Benchmarks of the joint model, and of the servo tick with 12 joints.
#include <benchmark/benchmark.h>

#include "haptics/joint/group.hpp"
#include "haptics/servo/tick.hpp"

namespace {

using namespace bolt;
using namespace bolt::joint;

JointDesign m16() {
    JointDesign d;
    d.thread = parse_thread("M16").value();
    d.bolt_class = property_class("8.8", 0.016).value();
    d.bolt_length = 0.075;
    d.washer_under_head = d.washer_under_nut = true;
    d.members = {{0.024, 110e9}, {0.024, 110e9}};
    d.friction.scatter = 0.06;
    return d;
}

// The argument is the number of joints. All are tight, on a 60 mm grid; a drive turns one nut on and off.
void group_tick(benchmark::State& state) {
    const auto n = static_cast<std::size_t>(state.range(0));
    std::vector<JointDesign> designs(n, m16());
    for (std::size_t i = 0; i < n; ++i)
        designs[i].seat = Vec3(0.06 * static_cast<double>(i % 40), 0.0, 0.06 * static_cast<double>(i / 40));
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    const GroupParameters group = make_group(designs, n > 1 ? &plate : nullptr, 1);
    std::vector<JointState> joints = initial_state(group, n);
    for (std::size_t i = 0; i < n; ++i) {
        joints[i].mechanistic.angle = joints[i].nut.angle = 0.3;  // a few kilonewtons
    }
    NutDrive drive;
    drive.engaged = true;
    drive.stiffness = 2000.0;
    drive.half_play = 0.01;
    double t = 0.0;
    for (auto _ : state) {
        t += 1e-3;
        drive.angle = 0.5 + 0.2 * std::sin(3.0 * t);
        step_group(group, joints, 0, drive, 1e-3);
        benchmark::DoNotOptimize(joints.data());
    }
    state.SetComplexityN(state.range(0));
    state.counters["per_joint"] = benchmark::Counter(
        static_cast<double>(n), benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(group_tick)->Arg(1)->Arg(12)->Arg(100)->Arg(1000)->Complexity(benchmark::oN);

// Baseline: a direct solution of the same closure by twenty Newton steps on the implicit equation.
void seat_by_newton(benchmark::State& state) {
    const SeatSpring seat{5.5e-9, 6.5e-6, 31.4};
    double x = 0.0;
    for (auto _ : state) {
        x = x > 2e-4 ? 1e-5 : x + 1e-8;
        double F = std::max(1.0, x / seat.compliance);
        for (int i = 0; i < 20; ++i) {
            const double f = seat.closure(F) - x;
            F = std::max(1e-9, F - f / (seat.compliance + seat.scale / F));
        }
        benchmark::DoNotOptimize(F);
    }
}
BENCHMARK(seat_by_newton);

void seat_closed_form(benchmark::State& state) {
    const SeatSpring seat{5.5e-9, 6.5e-6, 31.4};
    double x = 0.0;
    for (auto _ : state) {
        x = x > 2e-4 ? 1e-5 : x + 1e-8;
        benchmark::DoNotOptimize(seat.at(x));
    }
}
BENCHMARK(seat_closed_form);

// The most expensive tick: a bolt that yields.
void yielding_tick(benchmark::State& state) {
    const JointDesign design = m16();
    const GroupParameters group = make_group({&design, 1}, nullptr, 1);
    std::vector<JointState> joints = initial_state(group, 1);
    double angle = 0.0;
    for (auto _ : state) {
        angle += 2e-4;
        if (joints[0].condition != JointCondition::intact) {
            state.PauseTiming();
            joints = initial_state(group, 1);
            angle = 0.9;
            state.ResumeTiming();
        }
        turn_nut(group, joints, 0, angle, 1.0, 1e-3);
        benchmark::DoNotOptimize(joints.data());
    }
}
BENCHMARK(yielding_tick);

void published_tick(benchmark::State& state) {
    const GroupParameters group = make_published_group({PublishedParameters{}});
    std::vector<JointState> joints = initial_state(group, 1);
    NutDrive drive;
    drive.engaged = true;
    drive.stiffness = 2000.0;
    double t = 0.0;
    for (auto _ : state) {
        t += 1e-3;
        drive.angle = to_radians(7125.0) + 0.1 * std::sin(3.0 * t);
        step_group(group, joints, 0, drive, 1e-3);
        benchmark::DoNotOptimize(joints.data());
    }
}
BENCHMARK(published_tick);

void servo_tick_12_joints(benchmark::State& state) {
    std::vector<JointDesign> designs(12, m16());
    for (std::size_t i = 0; i < 12; ++i) designs[i].seat = Vec3(0.06 * static_cast<double>(i), 0.0, 0.0);
    const FlangePlate plate = FlangePlate::make(0.024, 110e9, 0.25, 1e11);
    servo::SetupDescription description;
    description.joints = designs;
    description.flange = &plate;
    description.tool.head = collision::make_jaw(0.0242, 0.26);
    description.tool.head_angle = 0.26;
    description.tool.handle_length = 0.23;
    description.max_torque = 200.0;
    const servo::Setup setup = servo::make_setup(description);
    servo::State servo = servo::initial_state(setup);
    servo::TickInput input;
    input.dead_man = true;
    input.grip = servo::Grip::fingers;
    const Vec3 centre = servo::nut_centre(setup.nuts[0], 0.0);
    for (int i = 0; i < 3; ++i) input.commanded_tool.position[i] = static_cast<float>(centre[i]);
    double t = 0.0;
    for (auto _ : state) {
        t += 1e-3;
        input.commanded_tool.orientation[0] = static_cast<float>(std::cos(t));
        input.commanded_tool.orientation[2] = static_cast<float>(std::sin(t));
        benchmark::DoNotOptimize(servo::tick(setup, servo, input));
    }
}
BENCHMARK(servo_tick_12_joints);

}  // namespace
