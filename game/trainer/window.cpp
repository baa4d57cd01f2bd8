#include "game/trainer/window.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "engine/gpu/restarts.hpp"
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
    view::Painter painter;
    std::unique_ptr<gpu::Swapchain> swapchain;

    Canvas() = default;
    Canvas(Canvas&&) = default;
    Canvas& operator=(Canvas&&) = delete;
    ~Canvas() {
        if (painter.device) (void)painter.device->idle();
    }
};

Result<Canvas> make_canvas(platform::Window& window, const gpu::Instance& instance,
                           const WindowChoice& choice) {
    const gpu::MakeSurface make_surface = [&] { return window.make_surface(instance); };
    Result<gpu::Surface> surface = make_surface();
    if (!surface) return fail(surface.error());
    render::RendererOptions renderer;
    renderer.level_error_px = level_error;
    Canvas canvas;
    Result<view::Painter> painter = view::make_painter(instance, {choice.gpu, surface->get()}, renderer);
    if (!painter) return fail(painter.error());
    canvas.painter = std::move(*painter);
    auto swapchain = gpu::Swapchain::create(*canvas.painter.device, std::move(*surface), make_surface);
    if (!swapchain) return fail(swapchain.error());
    canvas.swapchain = std::move(*swapchain);
    return canvas;
}

Status draw(App& app, Canvas& canvas, platform::Window& window, std::span<const platform::Event> events,
            double passed) {
    const Result<VkExtent2D> size = canvas.swapchain->ready(size_of(window));
    if (!size) return fail(size.error());
    if (size->width == 0 || size->height == 0) return app.unseen();  // minimised: the lesson waits
    const Result<gpu::Frame*> frame = canvas.painter.frames->begin();
    if (!frame) return fail(frame.error());
    if (Status drawn = app.frame(**frame, events, *size, window.content_scale(), passed); !drawn)
        return drawn;
    const render::Layer picture = canvas.painter.renderer->picture(0);
    const Result<bool> shown =
        canvas.swapchain->show(*canvas.painter.frames, **frame, *picture.image, picture.layer);
    if (!shown) return fail(shown.error());
    return {};
}

Status until_closed(App& app, Canvas& canvas, platform::Window& window, const WindowChoice& choice) {
    platform::Pace pace{platform::Clock::now(), platform::period_of(window.refresh()), 0};
    double last = seconds();
    while (!app.closed() && !(choice.stop && choice.stop())) {
        const bool nothing_to_see = canvas.swapchain->plan().extent.width == 0;
        const std::vector<platform::Event> events =
            nothing_to_see ? window.wait_for_events(0.1) : window.events();
        if (Status there = window.there(); !there) return there;
        for (const platform::Event& event : events)
            if (nothing_to_see && std::holds_alternative<platform::CloseEvent>(event)) return {};
        const double now = seconds(), passed = now - last;
        last = now;
        if (Status done = draw(app, canvas, window, events, passed); !done) {
            // What cannot be shown for want of a display is no fault of the GPU.
            Status there = window.there();
            return there ? done : there;
        }
        if (app.wants_full_screen()) window.set_full_screen(!window.full_screen());
        (void)platform::wait_for_due(pace);
    }
    return {};
}

}  // namespace

Status run_in_window(App& app, platform::Window& window, const gpu::Instance& instance,
                     const WindowChoice& choice) {
    gpu::Restarts restarts;
    for (;;) {
        Status done;
        {
            Result<Canvas> canvas = make_canvas(window, instance, choice);
            if (!canvas) {
                done = fail(canvas.error());
            } else {
                done = app.start(canvas->painter);
                if (done) done = until_closed(app, *canvas, window, choice);
                app.drop();
                (void)canvas->painter.renderer->save_pipelines();  // without them the next start is slower
            }
        }
        if (done || !done.error().lost) {
            const Status ended = app.end_lesson();
            return done ? ended : done;
        }
        if (!restarts.again(seconds())) {
            (void)app.end_lesson();
            return fail(ErrorCode::no_device,
                        fmt::format("the GPU was lost twice within {:.0f} s: {}", gpu::Restarts::patience,
                                    done.error().what),
                        "another GPU or driver: boltwright doctor lists them, --gpu chooses");
        }
        (void)std::fprintf(stderr, "the GPU was lost (%s) and is started again\n", done.error().what.c_str());
    }
}

}  // namespace bolt::trainer
