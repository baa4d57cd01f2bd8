// The loop of a process that shows walls in step with the first process.
#include "engine/gpu/device.hpp"
#include "game/view/walls.hpp"
#include "game/view/window.hpp"

namespace bolt::view {

namespace {

Status draw_followed(WindowContent& content, Walls& walls, const GpuContext& gpu, const ClusterFrame& shared,
                     WallFollower& follower, bool& ended) {
    cluster::MessageReader message(shared.content);
    cluster::MessageReader bulk(shared.bulk);
    BOLT_TRY(content.follow(message, bulk));
    BOLT_TRY_ASSIGN(const ImmersiveFrame immersive, walls.begin_frame(shared.head, shared.tracked));
    WindowFrame window;
    window.immersive = &immersive;
    BOLT_TRY(content.update(window));
    BOLT_TRY_ASSIGN(const auto recorded, gpu.frames->begin());
    BOLT_TRY(content.draw(*recorded, window));
    std::vector<gpu::WindowPictures> windows;
    walls.add_pictures(*gpu.renderer, immersive, windows);
    const std::vector<platform::InputEvent> events = walls.poll_events();
    BOLT_TRY(gpu::present(*gpu.frames, *recorded, windows, [&]() -> Status {
        BOLT_TRY(gpu.device->idle());
        BOLT_TRY_ASSIGN(const bool may_present, follower.wait_for_permission(events));
        ended = !may_present;
        return {};
    }));
    follower.presented();
    return {};
}

Status follow_until_end(WindowContent& content, Walls& walls, const GpuContext& gpu, WallFollower& follower) {
    for (bool ended = false; !ended;) {
        BOLT_TRY_ASSIGN(const auto shared, follower.next_frame());
        if (!shared) return {};
        BOLT_TRY(draw_followed(content, walls, gpu, *shared, follower, ended));
    }
    return {};
}

}  // namespace

Status follow_on_walls(WindowContent& content, Walls& walls, WallFollower& follower,
                       const gpu::Instance& instance, const std::string& gpu) {
    BOLT_TRY_ASSIGN(const auto surface, walls.make_surface(instance));
    render::RendererOptions renderer;
    renderer.level_error_px = window_level_error;
    BOLT_TRY_ASSIGN(auto context, make_gpu_context(instance, {gpu, surface.get(), nullptr}, renderer));
    Status done = walls.start(*context.device, instance);
    if (done) done = content.start(context);
    if (done) done = follow_until_end(content, walls, context, follower);
    (void)context.device->idle();
    content.release();
    walls.release();
    (void)context.renderer->save_pipelines();
    return done;
}

}  // namespace bolt::view
