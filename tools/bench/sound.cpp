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
constexpr double piece = 0.02;  // s
using Piece = std::array<float, static_cast<std::size_t>(piece* rate)>;

// "x_real_time" is seconds of sound per second on one core.
void count(benchmark::State& state) {
    state.counters["x_real_time"] =
        benchmark::Counter(piece * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

servo::Setup workplace() {
    const content::Loaded loaded = content::load_assembly("cover-m8");
    return loaded.ok() ? session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 1e-3)
                       : servo::Setup{};
}

// The worst case: all sounds at once.
void sound_all(benchmark::State& state) {
    sound::Synth synth = sound::make_synth(workplace(), rate);
    sound::Heard heard;
    heard.strike = heard.slide = 0.2F;
    heard.press = 5.0F;
    heard.run = 9.0F;
    heard.creep = 0.5F;
    heard.load = heard.slip = 0.8F;
    heard.click = heard.done = heard.mistake = true;
    Piece samples{};
    for (auto _ : state) {
        for (std::size_t i = 0; i < 20; ++i) {
            sound::sound(synth, heard);
            sound::render(synth, std::span(samples).subspan(48 * i, 48));
        }
        benchmark::DoNotOptimize(samples);
    }
    count(state);
}
BENCHMARK(sound_all)->Unit(benchmark::kMicrosecond);

// The usual case: silence.
void sound_silence(benchmark::State& state) {
    sound::Synth synth = sound::make_synth(workplace(), rate);
    Piece samples{};
    for (auto _ : state) {
        sound::render(synth, samples);
        benchmark::DoNotOptimize(samples);
    }
    count(state);
}
BENCHMARK(sound_silence)->Unit(benchmark::kMicrosecond);

// The work of the frame's thread for 20 ms of ticks.
void sound_ear(benchmark::State& state) {
    const servo::Setup setup = workplace();
    if (setup.nuts.empty()) {
        state.SkipWithError("cover-m8 does not load");
        return;
    }
    sound::Ear ear;
    world::World world;
    world::add_haptics(world, servo::initial_state(setup));
    servo::Output output;
    output.joint = 0;
    output.touched = collision::ObstacleId::fixed(3);
    for (auto _ : state)
        for (int i = 0; i < 20; ++i) {
            output.tool.position.x += 1e-4;
            output.nut_angle += 1e-3;
            world::write_output(world, output);
            benchmark::DoNotOptimize(sound::hear(ear, setup, world));
        }
    count(state);
}
BENCHMARK(sound_ear)->Unit(benchmark::kMicrosecond);

// Baseline: eight plain sines, each by std::sin.
void sound_sines(benchmark::State& state) {
    std::array<double, 8> phases{};
    Piece samples{};
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
    count(state);
}
BENCHMARK(sound_sines)->Unit(benchmark::kMicrosecond);

}  // namespace
