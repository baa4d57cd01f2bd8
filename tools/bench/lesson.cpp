#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "content/format/assembly.hpp"
#include "game/session/servo_setup.hpp"
#include "game/trainees/train.hpp"
#include "game/trainees/trainee.hpp"

namespace {

using namespace bolt;

// The whole headless lesson, session file included; "x_real_time" is virtual seconds per second on one core.
void headless_lesson(benchmark::State& state) {
    const content::Loaded loaded = content::load_assembly("zq350");
    if (!loaded.ok()) {
        state.SkipWithError(loaded.errors.front().message().c_str());
        return;
    }
    const auto file = std::filesystem::temp_directory_path() / "bolt-bench.boltwright";
    trainees::TrainOptions options;
    options.trainee = trainees::find_profile("expert").value();
    double seconds = 0.0;
    for (auto _ : state) {
        const auto result =
            trainees::train(loaded.assembly, options, file, [](const trainees::Progress&) { return true; });
        if (!result) {
            state.SkipWithError(result.error().message().c_str());
            break;
        }
        seconds += result->result.duration;
    }
    state.counters["x_real_time"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
    std::error_code ignored;
    state.counters["session_MB"] = static_cast<double>(std::filesystem::file_size(file, ignored)) / 1e6;
    std::filesystem::remove(file, ignored);
}
BENCHMARK(headless_lesson)->Unit(benchmark::kMillisecond);

// Baseline: the same lesson without recording.
void headless_lesson_unrecorded(benchmark::State& state) {
    const content::Loaded loaded = content::load_assembly("zq350");
    if (!loaded.ok()) {
        state.SkipWithError(loaded.errors.front().message().c_str());
        return;
    }
    const servo::Setup setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 1e-3);
    double seconds = 0.0;
    for (auto _ : state) {
        servo::State servo = servo::initial_state(setup);
        lesson::Lesson lesson = lesson::begin(loaded.assembly, lesson::Mode::guided, lesson::Task::tighten);
        trainees::Operator trainee(trainees::find_profile("expert").value(), 1, setup);
        while (lesson.due() != nullptr && servo.tick < 7'200'000) {
            const servo::Input input = trainee.act(setup, servo, lesson);
            const servo::Output output = servo::tick(setup, servo, input);
            lesson::observe(lesson, servo, output);
            lesson.events.clear();
        }
        seconds += static_cast<double>(servo.tick) * 1e-3;
    }
    state.counters["x_real_time"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
}
BENCHMARK(headless_lesson_unrecorded)->Unit(benchmark::kMillisecond);

}  // namespace
