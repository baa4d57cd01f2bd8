#include "game/view/window.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>

#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/pace.hpp"

namespace bolt::view {

namespace {

constexpr float level_error = 0.7F;  // px

double seconds() { return std::chrono::duration<double>(platform::Clock::now().time_since_epoch()).count(); }

VkExtent2D size_of(const platform::Window& window) {
    const platform::Size size = window.pixels();
    return {size.width, size.height};
}

// The GPU and the swapchain of the window. The destructor waits until the GPU is idle.
struct Canvas {
    GpuContext gpu_context;
    std::unique_ptr<gpu::Swapchain> swapchain;

    Canvas() = default;
    Canvas(Canvas&&) = default;
    Canvas& operator=(Canvas&&) = delete;
    ~Canvas() {
        if (gpu_context.device) (void)gpu_context.device->idle();
    }
};

Result<Canvas> make_canvas(platform::Window& window, const gpu::Instance& instance,
                           const WindowRunOptions& options) {
    const gpu::MakeSurface make_surface = [&] { return window.make_surface(instance); };
    BOLT_TRY_ASSIGN(auto surface, make_surface());
    render::RendererOptions renderer;
    renderer.level_error_px = level_error;
    Canvas canvas;
    BOLT_TRY_ASSIGN(auto gpu_context, make_gpu_context(instance, {options.gpu, surface.get()}, renderer));
    canvas.gpu_context = std::move(gpu_context);
    BOLT_TRY_ASSIGN(auto swapchain,
                    gpu::Swapchain::create(*canvas.gpu_context.device, std::move(surface), make_surface));
    canvas.swapchain = std::move(swapchain);
    return canvas;
}

Status draw(WindowContent& content, Canvas& canvas, platform::Window& window,
            std::span<const platform::InputEvent> events, double elapsed) {
    BOLT_TRY_ASSIGN(const auto size, canvas.swapchain->prepare(size_of(window)));
    if (size.width == 0 || size.height == 0) return content.frame_while_hidden();
    BOLT_TRY_ASSIGN(const auto frame, canvas.gpu_context.frames->begin());
    BOLT_TRY(content.frame(*frame, events, size, window.content_scale(), elapsed));
    const render::ImageLayer picture = canvas.gpu_context.renderer->picture(0);
    BOLT_TRY(canvas.swapchain->present(*canvas.gpu_context.frames, *frame, *picture.image, picture.layer));
    return {};
}

Status run_until_closed(WindowContent& content, Canvas& canvas, platform::Window& window,
                        const WindowRunOptions& options) {
    platform::Pace pace{platform::Clock::now(), platform::period_of(window.refresh_rate()), 0};
    double last = seconds();
    while (!content.closed() && !(options.stop && options.stop())) {
        const bool minimised = canvas.swapchain->plan().extent.width == 0;
        const std::vector<platform::InputEvent> events =
            minimised ? window.wait_for_events(0.1) : window.poll_events();
        BOLT_TRY(window.display_status());
        for (const platform::InputEvent& event : events)
            if (minimised && std::holds_alternative<platform::CloseEvent>(event)) return {};
        const double now = seconds(), elapsed = now - last;
        last = now;
        if (Status done = draw(content, canvas, window, events, elapsed); !done) {
            // If the display server has ended, report that instead of the failed presentation.
            Status display = window.display_status();
            return display ? done : display;
        }
        if (content.take_full_screen_request()) window.set_full_screen(!window.full_screen());
        (void)platform::wait_for_deadline(pace);
    }
    return {};
}

}  // namespace

void OrbitControl::stop() {
    drag_ = Drag::none;
    held_ = platform::Button::other;
}

bool OrbitControl::apply(std::span<const platform::InputEvent> events, const PictureShape& picture,
                         Orbit& orbit, const render::BoundingBox& box) {
    using namespace platform;
    bool moved = false;
    for (const InputEvent& event : events) {
        if (const auto* button = std::get_if<ButtonEvent>(&event)) {
            cursor_ = button->at;
            // A second button is ignored while one is held.
            if (button->down && drag_ == Drag::none && button->button != Button::other) {
                drag_ = button->button == Button::left ? Drag::turn : Drag::pan;
                held_ = button->button;
            } else if (!button->down && button->button == held_) {
                stop();
            }
        } else if (const auto* cursor = std::get_if<CursorEvent>(&event)) {
            const glm::dvec2 motion = (cursor->at - cursor_) / picture.height;
            cursor_ = cursor->at;
            if (drag_ == Drag::turn) turn(orbit, {motion.x, -motion.y});
            if (drag_ == Drag::pan) pan(orbit, {motion.x, -motion.y});
            moved = moved || drag_ != Drag::none;
        } else if (const auto* wheel = std::get_if<WheelEvent>(&event)) {
            const glm::dvec2 at(wheel->at.x / picture.height - 0.5 * picture.aspect,
                                0.5 - wheel->at.y / picture.height);
            zoom(orbit, wheel->notches.y, at, box);
            moved = true;
        } else if (const auto* focus = std::get_if<FocusEvent>(&event)) {
            if (!focus->focused) stop();  // the release may go to another window
        }
    }
    return moved;
}

Status run_in_window(WindowContent& content, platform::Window& window, const gpu::Instance& instance,
                     const WindowRunOptions& options) {
    gpu::DeviceLossPolicy loss_policy;
    for (;;) {
        Status result;
        {
            Result<Canvas> canvas = make_canvas(window, instance, options);
            if (!canvas) {
                result = fail(canvas.error());
            } else {
                result = content.start(canvas->gpu_context);
                if (result) result = run_until_closed(content, *canvas, window, options);
                content.release();
                // Without the saved pipelines the next start is only slower.
                (void)canvas->gpu_context.renderer->save_pipelines();
            }
        }
        if (result || !result.error().lost) {
            const Status ended = content.end();
            return result ? ended : result;
        }
        if (!loss_policy.should_restart(seconds())) {
            (void)content.end();
            return fail(ErrorCode::no_device,
                        fmt::format("the GPU was lost twice within {:.0f} s: {}",
                                    gpu::DeviceLossPolicy::min_interval, result.error().what),
                        "another GPU or driver: boltwright doctor lists them, --gpu chooses");
        }
        (void)std::fprintf(stderr, "the GPU was lost (%s) and is started again\n",
                           result.error().what.c_str());
    }
}

}  // namespace bolt::view
