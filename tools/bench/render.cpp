// The cost of a frame, pass by pass, beside the minimal renderer of the same triangles (bare.hpp). The two
// alternate, so that other load slows both. `x_bare` is the ratio.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <map>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/picture.hpp"
#include "tools/bench/bare.hpp"
#include "tools/bench/machine.hpp"
#include "tools/bench/need.hpp"

namespace {

using namespace bolt;
using bench::Clock;
using bench::cpu_milliseconds;
using bench::guarded;
using bench::milliseconds_since;
using bench::need;

constexpr VkExtent2D extent{1280, 720};

// All objects that a frame needs, destroyed in reverse order.
struct Studio {
    gpu::Instance instance = need(gpu::Instance::create({}));
    std::unique_ptr<gpu::Device> device = need(gpu::Device::create(instance, {}));
    std::unique_ptr<gpu::Frames> frames = need(gpu::Frames::create(*device));
    std::unique_ptr<render::Renderer> renderer;

    explicit Studio(float level_error_px = 0.0F) {
        render::RendererOptions options;
        options.level_error_px = level_error_px;
        renderer = need(render::Renderer::create(*device, options));
    }
};

// The scene of `boltwright render`: studio light, one lamp with a shadow, ambient occlusion.
struct Subject {
    render::GpuModel gpu_model;
    render::EnvironmentLight light;
    render::Scene scene;
    render::Eye eye;

    Subject(gpu::Device& device, const assets::Model& model, const glm::vec3& from, const glm::vec3& to,
            bool levels = false)
        : gpu_model(need(render::upload_model(device, model, {levels}))),
          light(need(render::upload_environment(device, shading::studio()))) {
        render::add_model(scene, model, gpu_model);
        render::SceneLight key;
        key.light.direction = glm::vec4(glm::normalize(glm::vec3(0.45F, -1.0F, -0.55F)), 0.0F);
        key.light.color = {1.6F, 1.55F, 1.5F, 0.0F};
        key.casts_shadow = true;
        scene.lights.push_back(key);
        scene.environment = &light;
        scene.background = {0.32F, 0.34F, 0.36F, 1.0F};
        const render::BoundingBox box = render::bounds(scene);
        scene.occlusion_radius = 0.04F * glm::distance(box.low, box.high);
        render::Perspective lens;
        lens.fov = 0.6108652F;  // 35°
        lens.aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
        eye = render::make_eye(from, to, lens);
    }
};

struct Settings {
    bool shadow_moves = false, occlusion = true;
    float level_error_px = 0.0F;  // 0: every triangle
};

void draw_frames(benchmark::State& state, const assets::Model& model, const glm::vec3& from,
                 const glm::vec3& to, const Settings& settings) {
    Studio studio(settings.level_error_px);
    Subject subject(*studio.device, model, from, to, settings.level_error_px > 0.0F);
    if (!settings.occlusion) subject.scene.occlusion_radius = 0.0F;
    auto bare = need(bench::BareRenderer::create(*studio.device, extent));
    std::map<std::string, double> passes;
    struct Cost {
        double time = 0.0, cpu = 0.0;  // ms
    };
    const auto timed = [&](const auto& record) {
        const double cpu = cpu_milliseconds();
        const Clock::time_point start = Clock::now();
        gpu::FrameContext& frame = *need(studio.frames->begin());
        need(record(frame));
        need(studio.frames->submit(frame));
        need(studio.frames->finish());
        return Cost{milliseconds_since(start), cpu_milliseconds() - cpu};
    };
    const auto full = [&](gpu::FrameContext& frame) {
        return studio.renderer->render(frame, subject.scene, {&subject.eye, 1}, extent);
    };
    const auto least = [&](gpu::FrameContext& frame) {
        return bare.render(frame, subject.scene, subject.eye);
    };
    timed(full);  // compiles the shaders
    timed(least);
    Cost ours, floor;
    const auto add = [](Cost& sum, const Cost& cost) {
        sum.time += cost.time;
        sum.cpu += cost.cpu;
        return cost.time;
    };
    std::vector<double> all;
    for (auto _ : state) {
        add(floor, timed(least));
        if (settings.shadow_moves) subject.scene.lights[0].light.direction.x += 1e-5F;
        all.push_back(add(ours, timed(full)));
        state.SetIterationTime(1e-3 * all.back());
        for (const gpu::PassTiming& pass : studio.frames->timings()) passes[pass.name] += pass.milliseconds;
    }
    const auto count = static_cast<double>(state.iterations());
    std::sort(all.begin(), all.end());
    state.counters["median_ms"] = all[all.size() / 2];
    state.counters["best_ms"] = all.front();
    state.counters["cpu_ms"] = ours.cpu / count;
    state.counters["bare_ms"] = floor.time / count;
    state.counters["bare_cpu_ms"] = floor.cpu / count;
    state.counters["x_bare"] = ours.time / floor.time;
    state.counters["x_bare_cpu"] = ours.cpu / floor.cpu;
    for (const auto& [name, sum] : passes) state.counters["gpu_" + name + "_ms"] = sum / count;
    const render::Statistics& statistics = studio.renderer->statistics();
    state.counters["triangles"] = static_cast<double>(statistics.triangles);
    state.counters["draws"] = statistics.draws;
    state.SetLabel(studio.device->name());
}

void frame_machine(benchmark::State& state, const Settings& settings) {
    guarded(state, [&] {
        draw_frames(state, bench::make_machine(), bench::machine_eye, bench::machine_target, settings);
    });
}
BENCHMARK_CAPTURE(frame_machine, shadow_kept, Settings{})->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame_machine, shadow_moves, Settings{true, true})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
// What three.js draws: no ambient occlusion.
BENCHMARK_CAPTURE(frame_machine, as_peer, Settings{false, false})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame_machine, as_peer_shadow_moves, Settings{true, false})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

std::string model_of(const char* assembly) {
    const content::Loaded loaded = content::load_assembly(assembly);
    if (!loaded.ok()) throw std::runtime_error(loaded.errors.front().message());
    return loaded.assembly.models.model;
}

void frame_zq350(benchmark::State& state, const Settings& settings) {
    guarded(state, [&] {
        const assets::Model model = need(assets::read_gltf(model_of("zq350")));
        draw_frames(state, model, {0.175F, 0.62F, 0.9F}, {0.175F, 0.04F, 0.0F}, settings);
    });
}
BENCHMARK_CAPTURE(frame_zq350, every_triangle, Settings{})->UseManualTime()->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame_zq350, levels_within_a_pixel, Settings{false, true, 1.0F})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

// From program start to the first picture of the ZQ350. The baseline is the second picture.
void first_picture(benchmark::State& state) {
    guarded(state, [&] {
        const std::string file = model_of("zq350");
        std::map<std::string, double> parts;
        double first = 0.0, second = 0.0;
        for (auto _ : state) {
            Clock::time_point since = Clock::now();
            const Clock::time_point start = since;
            const auto lap = [&](const char* name) {
                parts[name] += milliseconds_since(since);
                since = Clock::now();
            };
            const assets::Model model = need(assets::read_gltf(file));
            lap("read_ms");
            Studio studio;
            lap("device_and_renderer_ms");
            Subject subject(*studio.device, model, {0.175F, 0.62F, 0.9F}, {0.175F, 0.04F, 0.0F});
            lap("upload_ms");
            const auto shoot = [&] {
                (void)need(render::take_pictures(*studio.device, *studio.frames, *studio.renderer,
                                                 subject.scene, {&subject.eye, 1}, extent));
            };
            shoot();
            lap("picture_ms");
            const double now = milliseconds_since(start);
            state.SetIterationTime(1e-3 * now);
            first += now;
            since = Clock::now();
            shoot();
            second += milliseconds_since(since);
        }
        for (const auto& [name, sum] : parts)
            state.counters[name] = sum / static_cast<double>(state.iterations());
        state.counters["x_second_picture"] = first / second;
    });
}
BENCHMARK(first_picture)->UseManualTime()->Unit(benchmark::kMillisecond);

}  // namespace
