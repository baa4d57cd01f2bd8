// Benchmarks of sound synthesis and event detection.
#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <cstdlib>

#include "content/format/assembly.hpp"
#include "game/session/lesson_session.hpp"
#include "game/sound/event_detection.hpp"
#include "game/sound/synth.hpp"
#include "game/world/world.hpp"

namespace {

using namespace bolt;

constexpr int rate = 48000;
constexpr double buffer_seconds = 0.02;  // s
using SoundBuffer = std::array<float, static_cast<std::size_t>(buffer_seconds* rate)>;

// Sets "x_real_time": seconds of sound per second on one core.
void report_real_time(benchmark::State& state) {
    state.counters["x_real_time"] = benchmark::Counter(
        buffer_seconds * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

servo::Setup make_setup() {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    return loaded.ok() ? session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 1e-3)
                       : servo::Setup{};
}

// The worst case: all sounds at once.
void sound_all(benchmark::State& state) {
    sound::Synth synth = sound::make_synth(make_setup(), rate);
    sound::SoundCues cues;
    cues.strike_speed = cues.slide_speed = 0.2F;
    cues.contact_force = 5.0F;
    cues.run_speed = 9.0F;
    cues.creep_speed = 0.5F;
    cues.load = cues.slip = 0.8F;
    cues.click = cues.done = cues.mistake = true;
    SoundBuffer samples{};
    for (auto _ : state) {
        for (std::size_t i = 0; i < 20; ++i) {
            sound::apply_cues(synth, cues);
            sound::render(synth, std::span(samples).subspan(48 * i, 48));
        }
        benchmark::DoNotOptimize(samples);
    }
    report_real_time(state);
}
BENCHMARK(sound_all)->Unit(benchmark::kMicrosecond);

// The usual case: silence.
void sound_silence(benchmark::State& state) {
    sound::Synth synth = sound::make_synth(make_setup(), rate);
    SoundBuffer samples{};
    for (auto _ : state) {
        sound::render(synth, samples);
        benchmark::DoNotOptimize(samples);
    }
    report_real_time(state);
}
BENCHMARK(sound_silence)->Unit(benchmark::kMicrosecond);

// The event detection in the frame's thread for 20 ms of ticks.
void sound_event_detection(benchmark::State& state) {
    const servo::Setup setup = make_setup();
    if (setup.nuts.empty()) {
        state.SkipWithError("cover-m8: cannot load");
        return;
    }
    sound::EventDetector detector;
    servo::State servo = servo::initial_state(setup);
    world::World world;
    world::add_haptics(world, servo);
    servo::Output output;
    output.joint = 0;
    output.touched = collision::ObstacleId::fixed(3);
    for (auto _ : state)
        for (int i = 0; i < 20; ++i) {
            output.constrained_tool.position.x += 1e-4;
            servo.joints[0].nut.angle += 1e-3;
            world::write_haptics(world, {servo, {}, output});
            benchmark::DoNotOptimize(sound::detect_events(detector, setup, world));
        }
    report_real_time(state);
}
BENCHMARK(sound_event_detection)->Unit(benchmark::kMicrosecond);

// Baseline: eight plain sines, each by std::sin.
void sound_sines(benchmark::State& state) {
    std::array<double, 8> phases{};
    SoundBuffer samples{};
    for (auto _ : state) {
        for (float& sample : samples) {
            double sum = 0.0;
            for (std::size_t i = 0; i < phases.size(); ++i) {
                phases[i] = std::fmod(phases[i] + 0.01 * static_cast<double>(i + 1), 2.0 * pi);
                sum += 0.1 * std::sin(phases[i]);
            }
            sample = static_cast<float>(sum);
        }
        benchmark::DoNotOptimize(samples);
    }
    report_real_time(state);
}
BENCHMARK(sound_sines)->Unit(benchmark::kMicrosecond);

}  // namespace
