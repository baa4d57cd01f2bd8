// Benchmarks of lessons: a headless lesson against real time, and the cost of a lesson per rendered frame
// (the servo ticks, the lesson that observes them and the session that records them, with a simulated expert
// among obstacles). The counters of lesson_frames are milliseconds of CPU time in a frame of 1/60 s.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "content/format/assembly.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tools/bench/harness.hpp"

namespace {

using namespace bolt;
using bench::run_or_skip;
using bench::unwrap;

// A whole headless lesson with its session file. "x_real_time" is virtual seconds per second on one core.
void headless_lesson(benchmark::State& state) {
    const content::LoadedAssembly loaded = content::load_assembly("zq350");
    if (!loaded.ok()) {
        state.SkipWithError(loaded.errors.front().message().c_str());
        return;
    }
    const auto file = std::filesystem::temp_directory_path() / "bolt-bench.boltwright";
    trainees::TrainOptions options;
    options.trainee = trainees::find_profile("expert").value();
    double seconds = 0.0;
    for (auto _ : state) {
        const auto result = trainees::train(loaded.assembly, options, file,
                                            [](const trainees::TrainingProgress&) { return true; });
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
    const content::LoadedAssembly loaded = content::load_assembly("zq350");
    if (!loaded.ok()) {
        state.SkipWithError(loaded.errors.front().message().c_str());
        return;
    }
    const servo::Setup setup = session::make_setup(loaded.assembly, joint::Law::mechanistic, {}, 1, 1e-3);
    double seconds = 0.0;
    for (auto _ : state) {
        servo::State servo = servo::initial_state(setup);
        world::World world;
        world::add_haptics(world, servo);
        lesson::Lesson lesson = lesson::begin(loaded.assembly, lesson::Mode::guided, lesson::Task::tighten);
        trainees::SimulatedTrainee trainee(trainees::find_profile("expert").value(), 1, setup);
        while (lesson.due() != nullptr && servo.tick < 7'200'000) {
            const servo::TickInput input = trainee.act(setup, servo, lesson);
            const servo::Output output = servo::tick(setup, servo, input);
            world::write_haptics(world, {servo, input, output});
            lesson::observe(lesson, world);
            lesson.events.clear();
        }
        seconds += static_cast<double>(servo.tick) * 1e-3;
    }
    state.counters["x_real_time"] = benchmark::Counter(seconds, benchmark::Counter::kIsRate);
}
BENCHMARK(headless_lesson_unrecorded)->Unit(benchmark::kMillisecond);

constexpr double frame_time = 1.0 / 60.0, time_limit = 3600.0;  // s

void lesson_frames(benchmark::State& state, const char* name, session::ObstacleUse obstacles,
                   const char* tool = "") {
    run_or_skip(state, [&] {
        content::LoadedAssembly loaded = content::load_assembly(name);
        if (!loaded.ok()) throw std::runtime_error(loaded.errors.front().message());
        if (*tool != '\0')
            if (const Status chosen = content::choose_tool(loaded.assembly, tool); !chosen)
                throw std::runtime_error(chosen.error().message());
        const auto file = std::filesystem::temp_directory_path() / "bolt-bench-frames.boltwright";
        session::LessonOptions options;
        options.obstacles = obstacles;
        std::vector<double> frames, touching;
        for (auto _ : state) {
            const auto session = unwrap(session::LessonSession::begin(loaded.assembly, options, file));
            session::LessonSession& lesson_session = *session;
            trainees::SimulatedTrainee expert(trainees::find_profile("expert").value(), 1,
                                              lesson_session.setup());
            world::World world;
            world::add_haptics(world, lesson_session.state());
            double frame_cost = 0.0;
            bool touches = false;
            for (double last_frame = 0.0; !lesson_session.finished() && lesson_session.time() < time_limit;) {
                const servo::TickInput input =
                    expert.act(lesson_session.setup(), lesson_session.state(), lesson_session.lesson());
                const double start = bench::thread_microseconds();
                const servo::Output output = unwrap(lesson_session.tick(world, input, expert.take_events()));
                frame_cost += 1e-3 * (bench::thread_microseconds() - start);
                touches = touches || !output.touched.is_none();
                if (lesson_session.time() < last_frame + frame_time) continue;
                last_frame += frame_time;
                frames.push_back(frame_cost);
                if (touches) touching.push_back(frame_cost);
                frame_cost = 0.0;
                touches = false;
            }
            state.counters["s"] = lesson_session.time();
        }
        for (const auto& [share_name, share] :
             {std::pair("p50", 0.5), std::pair("p99", 0.99), std::pair("max", 1.0)}) {
            state.counters[share_name] = bench::quantile(frames, share);
            state.counters["touching_" + std::string(share_name)] = bench::quantile(touching, share);
        }
        double over = 0.0;
        for (const double frame_cost : frames) over += frame_cost > 1.0 ? 1.0 : 0.0;
        state.counters["over_1_ms"] = over / static_cast<double>(frames.size());
        for (const char* end : {"", "-wal", "-shm"}) std::filesystem::remove(file.string() + end);
    });
}

#define LESSON_FRAMES(name, ...) \
    BENCHMARK_CAPTURE(lesson_frames, name, __VA_ARGS__)->Iterations(1)->Unit(benchmark::kMillisecond)

LESSON_FRAMES(cover_m8, "cover-m8", session::ObstacleUse::required);
LESSON_FRAMES(zq350, "zq350", session::ObstacleUse::required);
// The same lesson with a tool that surrounds the nut; baseline: the open end.
LESSON_FRAMES(dn200_open_end, "dn200-pn16", session::ObstacleUse::required);
LESSON_FRAMES(dn200_ring, "dn200-pn16", session::ObstacleUse::required, "ring");
LESSON_FRAMES(dn200_ratchet, "dn200-pn16", session::ObstacleUse::required, "ratchet");
// Baseline: without obstacles.
LESSON_FRAMES(zq350_without_obstacles, "zq350", session::ObstacleUse::none);

}  // namespace
