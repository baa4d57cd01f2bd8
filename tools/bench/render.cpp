// Benchmarks of the renderer: the cost of a frame, pass by pass, and that of a minimal renderer of the same
// triangles. The two alternate, so that other load slows both; `x_bare` is the ratio.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <map>

#include "content/format/assembly.hpp"
#include "engine/assets/gltf.hpp"
#include "engine/gpu/pipeline.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/render/camera.hpp"
#include "engine/render/renderer.hpp"
#include "game/view/scene_stream.hpp"
#include "tools/bench/harness.hpp"
#include "tools/bench/machine.hpp"

namespace bolt::bench {

// A minimal renderer: one colour per part, 4 samples per pixel, no light, no culling, no sorting. The
// difference to it is the cost of the real renderer's lighting.
class BareRenderer {
  public:
    static Result<BareRenderer> create(gpu::Device& device, VkExtent2D extent);

    Status render(gpu::FrameContext& frame, const render::Scene& scene, const render::Eye& eye);

  private:
    VkExtent2D extent_{};
    gpu::PipelineCache cache_;
    gpu::Pipeline pipeline_;
    gpu::Image drawn_, depth_, picture_;
};

}  // namespace bolt::bench

std::span<const std::uint32_t> bench_shaders(std::string_view name);

namespace bolt::bench {

namespace {

using gpu::ResourceUse;

struct BarePushConstants {
    glm::mat4 clip_from_object;
    glm::vec4 color;
};

Result<gpu::Image> make_target(gpu::Device& device, VkExtent2D extent, VkFormat format,
                               VkSampleCountFlagBits samples, VkImageUsageFlags usage) {
    gpu::ImageInfo info;
    info.extent = extent;
    info.format = format;
    info.samples = samples;
    info.usage = usage;
    return gpu::Image::create(device, info);
}

template <class T>
Status assign(T& to, Result<T> made) {
    if (!made) return fail(made.error());
    to = std::move(*made);
    return {};
}

}  // namespace

Result<BareRenderer> BareRenderer::create(gpu::Device& device, VkExtent2D extent) {
    BareRenderer bare;
    bare.extent_ = extent;
    BOLT_TRY(assign(bare.cache_, gpu::PipelineCache::open(device, {})));
    BOLT_TRY_ASSIGN(const auto vertex, gpu::make_shader("bare.vert", bench_shaders("bare.vert")));
    BOLT_TRY_ASSIGN(const auto fragment, gpu::make_shader("bare.frag", bench_shaders("bare.frag")));
    gpu::GraphicsInfo info;
    info.vertex = &vertex;
    info.fragment = &fragment;
    info.streams = {{0, VK_FORMAT_R32G32B32_SFLOAT, 0, 0}};
    info.strides = {sizeof(glm::vec3)};
    info.colors = {render::color_format};
    info.depth = render::depth_format;
    info.samples = VK_SAMPLE_COUNT_4_BIT;
    BOLT_TRY(assign(bare.pipeline_, gpu::make_graphics_pipeline(device, bare.cache_, info)));
    Status s = assign(bare.drawn_, make_target(device, extent, render::color_format, VK_SAMPLE_COUNT_4_BIT,
                                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT));
    if (s)
        s = assign(bare.depth_, make_target(device, extent, render::depth_format, VK_SAMPLE_COUNT_4_BIT,
                                            VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
    if (s)
        s = assign(bare.picture_,
                   make_target(device, extent, render::color_format, VK_SAMPLE_COUNT_1_BIT,
                               VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT));
    if (!s) return fail(s.error());
    return bare;
}

Status BareRenderer::render(gpu::FrameContext& frame, const render::Scene& scene, const render::Eye& eye) {
    const VkCommandBuffer commands = frame.commands();
    frame.begin_timing("bare");
    gpu::image_barrier_discarding(commands, drawn_.get(), ResourceUse::color_target,
                                  ResourceUse::color_target);
    gpu::image_barrier_discarding(commands, depth_.get(), ResourceUse::depth_target,
                                  ResourceUse::depth_target, {VK_IMAGE_ASPECT_DEPTH_BIT});
    gpu::image_barrier_discarding(commands, picture_.get(), ResourceUse::transfer_from,
                                  ResourceUse::color_target);
    VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    color.imageView = drawn_.view();
    color.imageLayout = color.resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    color.resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT;
    color.resolveImageView = picture_.view();
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    VkRenderingAttachmentInfo depth{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    depth.imageView = depth_.view();
    depth.imageLayout = VK_IMAGE_LAYOUT_DEPTH_ATTACHMENT_OPTIMAL;
    depth.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    depth.storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = extent_;
    rendering.layerCount = 1;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachments = &color;
    rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &rendering);
    const VkViewport viewport{
        0.0F, 0.0F, static_cast<float>(extent_.width), static_cast<float>(extent_.height), 0.0F, 1.0F};
    const VkRect2D scissor{{0, 0}, extent_};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_.handle.get());
    for (const render::Object& object : scene.objects) {
        const VkBuffer positions = object.model->positions.get();
        constexpr VkDeviceSize start = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &positions, &start);
        vkCmdBindIndexBuffer(commands, object.model->indices.get(), 0, VK_INDEX_TYPE_UINT32);
        const render::MeshRange range = object.model->meshes[object.mesh];
        for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
            const render::MeshPart& part = object.model->parts[i];
            const render::LevelRange& all = part.levels.front();
            const BarePushConstants push{
                eye.clip_from_world * object.world,
                glm::vec4(glm::vec3(0.25F + 0.07F * static_cast<float>(i % 8)), 1.0F)};
            vkCmdPushConstants(commands, pipeline_.layout.get(), pipeline_.push_stages, 0, sizeof push,
                               &push);
            vkCmdDrawIndexed(commands, all.index_count, 1, all.first_index, part.first_vertex, 0);
        }
    }
    vkCmdEndRendering(commands);
    gpu::image_barrier(commands, picture_.get(), ResourceUse::color_target, ResourceUse::transfer_from);
    frame.end_timing();
    return {};
}

}  // namespace bolt::bench

namespace {

using namespace bolt;
using bench::cpu_milliseconds;
using bench::milliseconds_since;
using bench::run_or_skip;
using bench::unwrap;
using bench::WallClock;

constexpr VkExtent2D extent{1280, 720};

// The objects that a frame needs, destroyed in reverse order.
struct RenderContext {
    gpu::Instance instance = unwrap(gpu::Instance::create({}));
    std::unique_ptr<gpu::Device> device = unwrap(gpu::Device::create(instance, {}));
    std::unique_ptr<gpu::Frames> frames = unwrap(gpu::Frames::create(*device));
    std::unique_ptr<render::Renderer> renderer;

    explicit RenderContext(const render::RendererOptions& options = {}) {
        renderer = unwrap(render::Renderer::create(*device, options));
    }
};

// The scene of `boltwright render`: studio light, one lamp with a shadow, ambient occlusion.
struct BenchScene {
    render::GpuModel gpu_model;
    render::EnvironmentLight light;
    render::Scene scene;
    render::Eye eye;

    BenchScene(gpu::Device& device, const assets::Model& model, const glm::vec3& from, const glm::vec3& to,
               bool levels = false)
        : gpu_model(unwrap(render::upload_model(device, model, {levels}))),
          light(unwrap(render::upload_environment(device, shading::studio_environment()))) {
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

struct FrameSettings {
    bool shadow_moves = false, occlusion = true;
    float level_error_px = 0.0F;  // 0: every triangle
};

void draw_frames(benchmark::State& state, const assets::Model& model, const glm::vec3& from,
                 const glm::vec3& to, const FrameSettings& settings) {
    render::RendererOptions options;
    options.level_error_px = settings.level_error_px;
    RenderContext context(options);
    BenchScene target(*context.device, model, from, to, settings.level_error_px > 0.0F);
    if (!settings.occlusion) target.scene.occlusion_radius = 0.0F;
    auto bare = unwrap(bench::BareRenderer::create(*context.device, extent));
    std::map<std::string, double> passes;
    struct FrameCost {
        double time = 0.0, cpu = 0.0;  // ms
    };
    const auto timed = [&](const auto& record) {
        const double cpu = cpu_milliseconds();
        const WallClock::time_point start = WallClock::now();
        gpu::FrameContext& frame = *unwrap(context.frames->begin());
        unwrap(record(frame));
        unwrap(context.frames->submit(frame));
        unwrap(context.frames->finish());
        return FrameCost{milliseconds_since(start), cpu_milliseconds() - cpu};
    };
    const auto full = [&](gpu::FrameContext& frame) {
        return context.renderer->render(frame, target.scene, {&target.eye, 1}, extent);
    };
    const auto minimal = [&](gpu::FrameContext& frame) {
        return bare.render(frame, target.scene, target.eye);
    };
    timed(full);  // compiles the shaders
    timed(minimal);
    FrameCost ours, floor;
    const auto add = [](FrameCost& sum, const FrameCost& cost) {
        sum.time += cost.time;
        sum.cpu += cost.cpu;
        return cost.time;
    };
    std::vector<double> all;
    for (auto _ : state) {
        add(floor, timed(minimal));
        if (settings.shadow_moves) target.scene.lights[0].light.direction.x += 1e-5F;
        all.push_back(add(ours, timed(full)));
        state.SetIterationTime(1e-3 * all.back());
        for (const gpu::PassTiming& pass : context.frames->timings()) passes[pass.name] += pass.milliseconds;
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
    const render::Statistics& statistics = context.renderer->statistics();
    state.counters["triangles"] = static_cast<double>(statistics.triangles);
    state.counters["draws"] = statistics.draws;
    state.SetLabel(context.device->name());
}

void frame_machine(benchmark::State& state, const FrameSettings& settings) {
    run_or_skip(state, [&] {
        draw_frames(state, bench::make_machine(), bench::machine_eye, bench::machine_target, settings);
    });
}
BENCHMARK_CAPTURE(frame_machine, shadow_kept, FrameSettings{})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame_machine, shadow_moves, FrameSettings{true, true})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
// The same as three.js draws: no ambient occlusion.
BENCHMARK_CAPTURE(frame_machine, as_peer, FrameSettings{false, false})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame_machine, as_peer_shadow_moves, FrameSettings{true, false})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

std::string model_of(const char* assembly) {
    const content::LoadedAssembly loaded = content::load_assembly(assembly);
    if (!loaded.ok()) throw std::runtime_error(loaded.errors.front().message());
    return loaded.assembly.models.model;
}

void frame_zq350(benchmark::State& state, const FrameSettings& settings) {
    run_or_skip(state, [&] {
        const assets::Model model = unwrap(assets::read_gltf(model_of("zq350")));
        draw_frames(state, model, {0.175F, 0.62F, 0.9F}, {0.175F, 0.04F, 0.0F}, settings);
    });
}
BENCHMARK_CAPTURE(frame_zq350, every_triangle, FrameSettings{})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(frame_zq350, levels_within_a_pixel, FrameSettings{false, true, 1.0F})
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond);

// Both eyes of the ZQ350 in one pass (multiview). Baseline: one pass for each eye.
void stereo_zq350(benchmark::State& state) {
    run_or_skip(state, [&] {
        const assets::Model model = unwrap(assets::read_gltf(model_of("zq350")));
        using Multiview = render::RendererOptions::Multiview;
        RenderContext together({.multiview = Multiview::always}), separate({.multiview = Multiview::never});
        const glm::vec3 from(0.175F, 0.62F, 0.9F), to(0.175F, 0.04F, 0.0F), right(0.032F, 0.0F, 0.0F);
        const auto milliseconds = [&](RenderContext& context, BenchScene& target) {
            render::Perspective lens;
            lens.fov = 0.6108652F;
            lens.aspect = static_cast<float>(extent.width) / static_cast<float>(extent.height);
            const std::array<render::Eye, 2> eyes{render::make_eye(from - right, to, lens),
                                                  render::make_eye(from + right, to, lens)};
            const WallClock::time_point start = WallClock::now();
            gpu::FrameContext& frame = *unwrap(context.frames->begin());
            unwrap(context.renderer->render(frame, target.scene, eyes, extent));
            unwrap(context.frames->submit(frame));
            unwrap(context.frames->finish());
            return milliseconds_since(start);
        };
        BenchScene scene_together(*together.device, model, from, to);
        BenchScene scene_separate(*separate.device, model, from, to);
        milliseconds(together, scene_together);  // compiles the shaders
        milliseconds(separate, scene_separate);
        double ours = 0.0, baseline = 0.0;
        for (auto _ : state) {
            baseline += milliseconds(separate, scene_separate);
            const double now = milliseconds(together, scene_together);
            state.SetIterationTime(1e-3 * now);
            ours += now;
        }
        state.counters["separate_ms"] = baseline / static_cast<double>(state.iterations());
        state.counters["x_separate"] = ours / baseline;
        state.SetLabel(together.device->name());
    });
}
BENCHMARK(stereo_zq350)->UseManualTime()->Unit(benchmark::kMillisecond);

// The scene of the ZQ350 for another process of projection walls, written and read, while one part in eight
// moves. Baseline: the whole scene in each frame.
void scene_stream_zq350(benchmark::State& state) {
    run_or_skip(state, [&] {
        const assets::Model model = unwrap(assets::read_gltf(model_of("zq350")));
        RenderContext context(render::RendererOptions{});
        BenchScene target(*context.device, model, {0.175F, 0.62F, 0.9F}, {0.175F, 0.04F, 0.0F});
        const view::StreamedModels models{{&target.gpu_model}, &target.light};
        view::SceneSender changes, whole;
        render::Scene by_changes, by_whole;
        const auto send = [&](view::SceneSender& sender, render::Scene& received) {
            cluster::MessageWriter message;
            sender.write(message, target.scene, models);
            cluster::MessageReader reader(message.message());
            unwrap(view::read_scene(reader, models, received));
            return static_cast<double>(message.size());
        };
        double bytes = 0.0, whole_bytes = 0.0, ours = 0.0, baseline = 0.0;
        send(changes, by_changes);
        for (auto _ : state) {
            for (std::size_t i = 0; i < target.scene.objects.size(); i += 8)
                target.scene.objects[i].world[3].y += 1e-6F;
            WallClock::time_point begun = WallClock::now();
            bytes = send(changes, by_changes);
            const double now = milliseconds_since(begun);
            state.SetIterationTime(1e-3 * now);
            ours += now;
            begun = WallClock::now();
            whole.restart();
            whole_bytes = send(whole, by_whole);
            baseline += milliseconds_since(begun);
        }
        state.counters["bytes"] = bytes;
        state.counters["whole_bytes"] = whole_bytes;
        state.counters["objects"] = static_cast<double>(target.scene.objects.size());
        state.counters["x_whole"] = ours / baseline;
    });
}
BENCHMARK(scene_stream_zq350)->UseManualTime()->Unit(benchmark::kMicrosecond);

// From the start of loading to the first image of the ZQ350. Baseline: the second image.
void first_picture(benchmark::State& state) {
    run_or_skip(state, [&] {
        const std::string file = model_of("zq350");
        std::map<std::string, double> parts;
        double first = 0.0, second = 0.0;
        for (auto _ : state) {
            WallClock::time_point since = WallClock::now();
            const WallClock::time_point start = since;
            const auto lap = [&](const char* name) {
                parts[name] += milliseconds_since(since);
                since = WallClock::now();
            };
            const assets::Model model = unwrap(assets::read_gltf(file));
            lap("read_ms");
            RenderContext context;
            lap("device_and_renderer_ms");
            BenchScene target(*context.device, model, {0.175F, 0.62F, 0.9F}, {0.175F, 0.04F, 0.0F});
            lap("upload_ms");
            const auto shoot = [&] {
                (void)unwrap(render::take_pictures(*context.device, *context.frames, *context.renderer,
                                                   target.scene, {&target.eye, 1}, extent));
            };
            shoot();
            lap("picture_ms");
            const double now = milliseconds_since(start);
            state.SetIterationTime(1e-3 * now);
            first += now;
            since = WallClock::now();
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
