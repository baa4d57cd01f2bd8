#include "game/trainer/window.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/pace.hpp"

namespace bolt::trainer {

namespace {

constexpr float level_error = 0.7F;  // px

double seconds() { return std::chrono::duration<double>(platform::Clock::now().time_since_epoch()).count(); }

VkExtent2D size_of(const platform::Window& window) {
    const platform::Size size = window.pixels();
    return {size.width, size.height};
}

// The GPU and the swapchain of the window. The destructor waits until the GPU is idle.
struct Canvas {
    view::GpuContext gpu_context;
    std::unique_ptr<gpu::Swapchain> swapchain;

    Canvas() = default;
    Canvas(Canvas&&) = default;
    Canvas& operator=(Canvas&&) = delete;
    ~Canvas() {
        if (gpu_context.device) (void)gpu_context.device->idle();
    }
};

Result<Canvas> make_canvas(platform::Window& window, const gpu::Instance& instance,
                           const WindowChoice& choice) {
    const gpu::MakeSurface make_surface = [&] { return window.make_surface(instance); };
    BOLT_TRY_ASSIGN(auto surface, make_surface());
    render::RendererOptions renderer;
    renderer.level_error_px = level_error;
    Canvas canvas;
    BOLT_TRY_ASSIGN(auto gpu_context,
                    view::make_gpu_context(instance, {choice.gpu, surface.get()}, renderer));
    canvas.gpu_context = std::move(gpu_context);
    BOLT_TRY_ASSIGN(auto swapchain,
                    gpu::Swapchain::create(*canvas.gpu_context.device, std::move(surface), make_surface));
    canvas.swapchain = std::move(swapchain);
    return canvas;
}

Status draw(App& app, Canvas& canvas, platform::Window& window, std::span<const platform::InputEvent> events,
            double elapsed) {
    BOLT_TRY_ASSIGN(const auto size, canvas.swapchain->prepare(size_of(window)));
    if (size.width == 0 || size.height == 0) return app.frame_while_hidden();
    BOLT_TRY_ASSIGN(const auto frame, canvas.gpu_context.frames->begin());
    BOLT_TRY(app.frame(*frame, events, size, window.content_scale(), elapsed));
    const render::ImageLayer picture = canvas.gpu_context.renderer->picture(0);
    BOLT_TRY(canvas.swapchain->present(*canvas.gpu_context.frames, *frame, *picture.image, picture.layer));
    return {};
}

Status run_until_closed(App& app, Canvas& canvas, platform::Window& window, const WindowChoice& choice) {
    platform::Pace pace{platform::Clock::now(), platform::period_of(window.refresh_rate()), 0};
    double last = seconds();
    while (!app.closed() && !(choice.stop && choice.stop())) {
        const bool minimised = canvas.swapchain->plan().extent.width == 0;
        const std::vector<platform::InputEvent> events =
            minimised ? window.wait_for_events(0.1) : window.poll_events();
        BOLT_TRY(window.display_status());
        for (const platform::InputEvent& event : events)
            if (minimised && std::holds_alternative<platform::CloseEvent>(event)) return {};
        const double now = seconds(), elapsed = now - last;
        last = now;
        if (Status done = draw(app, canvas, window, events, elapsed); !done) {
            // If the display server has ended, report that instead of the failed presentation.
            Status display = window.display_status();
            return display ? done : display;
        }
        if (app.take_full_screen_request()) window.set_full_screen(!window.full_screen());
        (void)platform::wait_for_deadline(pace);
    }
    return {};
}

}  // namespace

Status run_in_window(App& app, platform::Window& window, const gpu::Instance& instance,
                     const WindowChoice& choice) {
    gpu::DeviceLossPolicy loss_policy;
    for (;;) {
        Status result;
        {
            Result<Canvas> canvas = make_canvas(window, instance, choice);
            if (!canvas) {
                result = fail(canvas.error());
            } else {
                result = app.start(canvas->gpu_context);
                if (result) result = run_until_closed(app, *canvas, window, choice);
                app.release();
                // Without the saved pipelines the next start is only slower.
                (void)canvas->gpu_context.renderer->save_pipelines();
            }
        }
        if (result || !result.error().lost) {
            const Status ended = app.end_lesson();
            return result ? ended : result;
        }
        if (!loss_policy.should_restart(seconds())) {
            (void)app.end_lesson();
            return fail(ErrorCode::no_device,
                        fmt::format("the GPU was lost twice within {:.0f} s: {}",
                                    gpu::DeviceLossPolicy::min_interval, result.error().what),
                        "another GPU or driver: boltwright doctor lists them, --gpu chooses");
        }
        (void)std::fprintf(stderr, "the GPU was lost (%s) and is started again\n",
                           result.error().what.c_str());
    }
}

}  // namespace bolt::trainer
