// The frames of a lesson in a headset: the trainer on the ZQ350 with both eyes and the panel, without a
// runtime. Baseline: the same lesson in a window of 1280 × 720.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>

#include "game/trainer/app.hpp"
#include "tools/bench/harness.hpp"

namespace bolt::bench {

namespace {

constexpr int warm_up = 8;  // frames: pipelines, uploads

// The eyes of a standing user who looks down at the workpiece.
view::ImmersiveFrame facing_frame(VkExtent2D size) {
    view::ImmersiveFrame made;
    made.head = {{0.0, 1.65, 0.0}, glm::angleAxis(to_radians(-30.0), Vec3(1.0, 0.0, 0.0))};
    made.tracked = made.attentive = true;
    view::EyeGroup group{size, {}};
    for (const double side : {-0.0315, 0.0315}) {
        const double out = to_radians(side < 0.0 ? 50.0 : 42.0), in = to_radians(side < 0.0 ? 42.0 : 50.0);
        group.eyes.push_back(render::make_eye(made.head * Pose{{side, 0.0, 0.0}, {1.0, 0.0, 0.0, 0.0}},
                                              {-out, in, to_radians(48.0), to_radians(-48.0)},
                                              view::immersive_range.near, view::immersive_range.far));
    }
    made.groups = {group};
    return made;
}

struct HeadsetLesson {
    gpu::Instance instance = unwrap(gpu::Instance::create({}));
    view::GpuContext gpu;
    std::unique_ptr<trainer::App> app;

    explicit HeadsetLesson(render::ScreenStage stage) {
        render::RendererOptions renderer;
        renderer.screen_stage = stage;
        renderer.level_error_px = 0.7F;
        renderer.keep_depth = true;
        gpu = unwrap(view::make_gpu_context(instance, {}, renderer));
        trainer::AppOptions options;
        options.choice.assembly = "zq350";
        options.choice.equipment.hand = trainer::HandMode::tracked;
        options.menu = false;
        options.out = std::filesystem::temp_directory_path() / "boltwright-bench";
        std::filesystem::create_directories(options.out);
        options.lesson.obstacles = session::ObstacleUse::if_any;
        app = std::make_unique<trainer::App>(std::move(options));
        unwrap(app->start(gpu));
    }
    HeadsetLesson(const HeadsetLesson&) = delete;
    HeadsetLesson& operator=(const HeadsetLesson&) = delete;
    ~HeadsetLesson() { app->release(); }
};

struct FrameCost {
    double update = 0.0, record = 0.0, whole = 0.0;  // ms of a frame; whole: with the GPU, pipelined
    std::map<std::string, double> passes;            // ms on the GPU, of the last frame
    std::uint32_t draws = 0;
    std::uint64_t triangles = 0;
};

FrameCost run(HeadsetLesson& lesson, const view::WindowFrame& window, int frames) {
    FrameCost cost;
    const WallClock::time_point begin = WallClock::now();
    for (int i = 0; i < frames; ++i) {
        const WallClock::time_point start = WallClock::now();
        unwrap(lesson.app->update(window));
        cost.update += milliseconds_since(start);
        gpu::FrameContext& frame = *unwrap(lesson.gpu.frames->begin());
        const WallClock::time_point recording = WallClock::now();
        unwrap(lesson.app->draw(frame, window));
        unwrap(lesson.gpu.frames->submit(frame));
        cost.record += milliseconds_since(recording);
        const std::uint32_t group = window.immersive != nullptr ? view::immersive_group : 0;
        cost.draws = lesson.gpu.renderer->statistics(group).draws;
        cost.triangles = lesson.gpu.renderer->statistics(group).triangles;
    }
    unwrap(lesson.gpu.frames->finish());
    cost.whole = milliseconds_since(begin);
    for (const gpu::PassTiming& pass : lesson.gpu.frames->timings())
        cost.passes[pass.name] += pass.milliseconds;
    for (double* sum : {&cost.update, &cost.record, &cost.whole}) *sum /= frames;
    return cost;
}

// Arguments: width and height of an eye's picture; the stage of ambient occlusion and lighting (0: fragment,
// 1: compute).
void headset_zq350(benchmark::State& state) {
    run_or_skip(state, [&] {
        HeadsetLesson lesson(static_cast<render::ScreenStage>(state.range(2)));
        const VkExtent2D size{static_cast<std::uint32_t>(state.range(0)),
                              static_cast<std::uint32_t>(state.range(1))};
        const view::ImmersiveFrame eyes = facing_frame(size);
        const view::WindowFrame room{{}, {1280, 720}, 1.0F, 1.0 / 90.0, &eyes},
            window{{}, {1280, 720}, 1.0F, 1.0 / 90.0, nullptr};
        constexpr int frames = 10;
        (void)run(lesson, room, warm_up);
        FrameCost cost;
        double whole = 0.0, baseline = 0.0;
        for (auto _ : state) {
            (void)run(lesson, window, 2);  // untimed: the lesson changes from room to window
            baseline += run(lesson, window, frames).whole;
            (void)run(lesson, room, 2);
            cost = run(lesson, room, frames);
            whole += cost.whole;
            state.SetIterationTime(1e-3 * cost.whole);
        }
        state.counters["frames_per_s"] = 1e3 * static_cast<double>(state.iterations()) / whole;
        state.counters["update_ms"] = cost.update;
        state.counters["record_ms"] = cost.record;
        double on_gpu = 0.0;
        for (const auto& [pass, milliseconds] : cost.passes) {
            state.counters["gpu_" + pass + "_ms"] = milliseconds;
            on_gpu += milliseconds;
        }
        state.counters["gpu_ms"] = on_gpu;
        state.counters["draws"] = cost.draws;
        state.counters["triangles_per_eye"] = static_cast<double>(cost.triangles);
        state.counters["x_window"] = whole / baseline;
        state.SetLabel(lesson.gpu.device->name());
    });
}
BENCHMARK(headset_zq350)
    ->Args({320, 240, 0})
    ->Args({320, 240, 1})
    ->Args({2064, 2208, 0})
    ->Args({2064, 2208, 1})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

}  // namespace

}  // namespace bolt::bench
