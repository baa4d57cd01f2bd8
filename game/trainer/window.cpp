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

// The GPU, and the window on it. What is drawn with is let go of only when nothing is being drawn.
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
            double passed) {
    BOLT_TRY_ASSIGN(const auto size, canvas.swapchain->prepare(size_of(window)));
    if (size.width == 0 || size.height == 0) return app.frame_while_hidden();
    BOLT_TRY_ASSIGN(const auto frame, canvas.gpu_context.frames->begin());
    BOLT_TRY(app.frame(*frame, events, size, window.content_scale(), passed));
    const render::ImageLayer picture = canvas.gpu_context.renderer->picture(0);
    BOLT_TRY(canvas.swapchain->present(*canvas.gpu_context.frames, *frame, *picture.image, picture.layer));
    return {};
}

Status until_closed(App& app, Canvas& canvas, platform::Window& window, const WindowChoice& choice) {
    platform::Pace pace{platform::Clock::now(), platform::period_of(window.refresh_rate()), 0};
    double last = seconds();
    while (!app.closed() && !(choice.stop && choice.stop())) {
        const bool nothing_to_see = canvas.swapchain->plan().extent.width == 0;
        const std::vector<platform::InputEvent> events =
            nothing_to_see ? window.wait_for_events(0.1) : window.poll_events();
        BOLT_TRY(window.display_status());
        for (const platform::InputEvent& event : events)
            if (nothing_to_see && std::holds_alternative<platform::CloseEvent>(event)) return {};
        const double now = seconds(), passed = now - last;
        last = now;
        if (Status done = draw(app, canvas, window, events, passed); !done) {
            // What cannot be shown for want of a display is no fault of the GPU.
            Status there = window.display_status();
            return there ? done : there;
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
        Status done;
        {
            Result<Canvas> canvas = make_canvas(window, instance, choice);
            if (!canvas) {
                done = fail(canvas.error());
            } else {
                done = app.start(canvas->gpu_context);
                if (done) done = until_closed(app, *canvas, window, choice);
                app.release();
                (void)
                    canvas->gpu_context.renderer->save_pipelines();  // without them the next start is slower
            }
        }
        if (done || !done.error().lost) {
            const Status ended = app.end_lesson();
            return done ? ended : done;
        }
        if (!loss_policy.should_restart(seconds())) {
            (void)app.end_lesson();
            return fail(ErrorCode::no_device,
                        fmt::format("the GPU was lost twice within {:.0f} s: {}",
                                    gpu::DeviceLossPolicy::min_interval, done.error().what),
                        "another GPU or driver: boltwright doctor lists them, --gpu chooses");
        }
        (void)std::fprintf(stderr, "the GPU was lost (%s) and is started again\n", done.error().what.c_str());
    }
}

}  // namespace bolt::trainer
