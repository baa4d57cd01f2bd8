#include "game/view/window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <utility>

#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/pace.hpp"
#include "game/view/resolution.hpp"
#include "game/view/walls.hpp"

namespace bolt::view {

namespace {

double seconds() { return std::chrono::duration<double>(platform::Clock::now().time_since_epoch()).count(); }

VkExtent2D size_of(const platform::Window& window) {
    const platform::Size size = window.pixels();
    return {size.width, size.height};
}

// At half the width and height, labels in the scene can still be read.
constexpr ResolutionControl full_in_window{.coarsest = 4};
constexpr double window_period = 1.0 / 30;  // s; a smooth lesson, with more pixels than at 60 Hz

// The GPU and the swapchain of the window. The destructor waits until the GPU is idle.
struct Canvas {
    GpuContext gpu_context;
    std::unique_ptr<gpu::Swapchain> swapchain;
    double last_frame = 0.0;  // s, when it began
    ResolutionControl headset_resolution, window_resolution = full_in_window;
    const ResolutionControl* adapted = nullptr;  // by the last frame; null: there was none
    int old_frames = 0;                          // frames in flight that were drawn at another resolution
    double late_since = 0.0;  // s, time since which the headset's runtime is late; 0: it is not
    bool hangs = false;       // it is late for so long that the window goes on without it
    std::optional<ImmersiveFrame> last_immersive;  // of the headset
    std::size_t mirrored_eyes = 0;                 // number of the headset's pictures of eyes
    std::optional<VkExtent2D> mirrored;            // size of the headset's picture in the window
    std::vector<platform::InputEvent> events;      // for the next frame

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
    renderer.level_error_px = window_level_error;
    renderer.keep_depth = options.headset != nullptr;
    // About 1°, because the head turns during the recording, which takes 1 to 2 ms.
    if (options.headset != nullptr) renderer.margin = 0.02F;
    gpu::VulkanCreator* creator = options.headset != nullptr ? options.headset->creator() : nullptr;
    Canvas canvas;
    BOLT_TRY_ASSIGN(auto gpu_context,
                    make_gpu_context(instance, {options.gpu, surface.get(), creator}, renderer));
    canvas.gpu_context = std::move(gpu_context);
    BOLT_TRY_ASSIGN(auto swapchain,
                    gpu::Swapchain::create(*canvas.gpu_context.device, std::move(surface), make_surface));
    canvas.swapchain = std::move(swapchain);
    return canvas;
}

// The pictures of the eyes, for the headset, and their depth if the renderer has kept it.
std::vector<xr::EyePicture> eye_pictures(const render::Renderer& renderer, const EyeGroup& group) {
    std::vector<xr::EyePicture> pictures;
    for (std::uint32_t eye = 0; eye < group.eyes.size(); ++eye) {
        const render::ImageLayer picture = renderer.picture(eye, immersive_group),
                                 depth = renderer.depth(eye, immersive_group);
        pictures.push_back({picture.image, picture.layer, depth.image, depth.layer, group.size});
    }
    return pictures;
}

// s, that the GPU took for the last completed frame; 0 on GPUs without timestamps.
double gpu_time(const GpuContext& gpu) {
    double sum = 0.0;
    for (const gpu::PassTiming& pass : gpu.frames->timings()) sum += 1e-3 * pass.milliseconds;
    return sum;
}

// The error of a headset that the program needs.
Error needed(Error error) {
    error.code = ErrorCode::no_device;
    error.lost = false;  // the GPU is not lost
    return error;
}

enum class Ending : std::uint8_t {
    closed,
    headset_found,    // the GPU objects are to be created by its runtime
    headset_refused,  // the GPU objects are to be created without it
    other_display,    // WindowContent::wants_other_display()
};

// Shows the content frame by frame, until it is closed.
class FrameLoop {
  public:
    FrameLoop(WindowContent& content, Canvas& canvas, platform::Window& window,
              const WindowRunOptions& options)
        : content_(content), canvas_(canvas), window_(window), options_(options) {}

    Result<Ending> run();

  private:
    // The display whose refreshes determine when frames are due.
    enum class Display : std::uint8_t { window, headset, walls };
    [[nodiscard]] Display display() const;
    // True if the window has no pixels to draw in.
    [[nodiscard]] bool minimised() const;
    [[nodiscard]] double refresh_rate() const;  // Hz, of window or walls; 0: unknown

    // Adds the events of all windows to those of the next frame. With `only_minimised`, a minimised window is
    // the only display: waits for events, and returns false if the window was closed, because the content
    // gets no frame with this event.
    bool poll_events(bool only_minimised);
    Status draw();
    Status draw_window(WindowFrame window);
    Status draw_headset(xr::HeadsetFrame& frame, WindowFrame window);
    // A frame of the content and the window while the headset's runtime is late.
    Status draw_late(WindowFrame window);
    // Moves the eyes of the recorded pictures to the latest prediction of the headset's pose.
    void latch_eyes(xr::HeadsetFrame& frame, const WindowFrame& window, ImmersiveFrame& immersive);
    // Submits the frame and shows the pictures of the eyes, of this size, in the window.
    Status present_mirror(gpu::FrameContext& recorded, VkExtent2D size);
    Status draw_walls(WindowFrame window);
    // Adapts the resolution to the time that the GPU took for the last frame. `period`: s, that a frame may
    // take; `elapsed`: s, since the last call.
    void adapt(ResolutionControl& resolution, double period, double elapsed);

    WindowContent& content_;
    Canvas& canvas_;
    platform::Window& window_;
    const WindowRunOptions& options_;
};

FrameLoop::Display FrameLoop::display() const {
    if (options_.walls != nullptr) return Display::walls;
    const bool headset = options_.headset != nullptr && options_.headset->running() && !canvas_.hangs;
    return headset ? Display::headset : Display::window;
}

bool FrameLoop::minimised() const {
    const VkExtent2D size = canvas_.swapchain->plan().extent;
    return size.width == 0 || size.height == 0;
}

double FrameLoop::refresh_rate() const {
    return options_.walls != nullptr ? options_.walls->refresh_rate() : window_.refresh_rate();
}

void FrameLoop::adapt(ResolutionControl& resolution, double period, double elapsed) {
    const bool other_display = std::exchange(canvas_.adapted, &resolution) != &resolution;
    if (!other_display && canvas_.old_frames > 0)
        --canvas_.old_frames;
    else if (other_display || update(resolution, {gpu_time(canvas_.gpu_context),
                                                  options_.adapts_resolution ? period : 0.0, elapsed}))
        canvas_.old_frames = gpu::frames_in_flight + 1;
}

Status FrameLoop::draw_window(WindowFrame window) {
    window.resolution = share_of(canvas_.window_resolution);
    BOLT_TRY(content_.update(window));
    BOLT_TRY_ASSIGN(const auto frame, canvas_.gpu_context.frames->begin());
    BOLT_TRY(content_.draw(*frame, window));
    const render::ImageLayer picture = content_.window_picture(*canvas_.gpu_context.renderer);
    BOLT_TRY(canvas_.swapchain->present(*canvas_.gpu_context.frames, *frame,
                                        {picture.image, picture.layer, {}, {}}));
    if (content_.scales_scene())
        adapt(canvas_.window_resolution, window_period, window.seconds);
    else
        canvas_.window_resolution = full_in_window;
    return {};
}

void FrameLoop::latch_eyes(xr::HeadsetFrame& frame, const WindowFrame& window, ImmersiveFrame& immersive) {
    const xr::HeadView recorded = frame.view;
    const std::vector<EyeGroup> recorded_groups = immersive.groups;
    options_.headset->locate(frame);
    if (frame.view.eyes.size() == recorded.eyes.size()) {
        immersive.groups = {eye_group(frame.view, recorded_groups.front().size)};
        if (content_.move_eyes(window)) return;
    }
    // The runtime must get the pose that the pictures are drawn for.
    frame.view = recorded;
    immersive.groups = recorded_groups;
}

// A frame of the headset; the window mirrors it (WindowContent::mirror), and never delays it.
Status FrameLoop::draw_headset(xr::HeadsetFrame& frame, WindowFrame window) {
    xr::Headset& headset = *options_.headset;
    GpuContext& gpu = canvas_.gpu_context;
    const VkExtent2D size = scaled(share_of(canvas_.headset_resolution), headset.session().extent());
    ImmersiveFrame immersive = immersive_frame(headset, frame);
    if (!frame.view.eyes.empty()) immersive.groups = {eye_group(frame.view, size)};
    window.immersive = &immersive;
    BOLT_TRY(content_.update(window));
    BOLT_TRY_ASSIGN(const auto recorded, gpu.frames->begin());
    canvas_.last_immersive = immersive;
    if (!immersive.groups.empty()) {
        headset.locate(frame);
        immersive.head = frame.view.head;
        immersive.groups = {eye_group(frame.view, size)};
    }
    BOLT_TRY(content_.draw(*recorded, window));
    // The user may have changed wants_passthrough() while the interface was drawn.
    frame.passthrough = immersive.has_passthrough && content_.wants_passthrough();
    const bool drawn = !immersive.groups.empty() && !immersive.groups.front().eyes.empty();
    if (drawn) latch_eyes(frame, window, immersive);
    if (!drawn) {
        BOLT_TRY(gpu.frames->submit(*recorded));
    } else {
        headset.record(recorded->commands(), eye_pictures(*gpu.renderer, immersive.groups.front()));
        canvas_.mirrored = size;
        canvas_.mirrored_eyes = immersive.groups.front().eyes.size();
        BOLT_TRY(present_mirror(*recorded, size));
    }
    headset.end_frame(frame, drawn, immersive_range);
    adapt(canvas_.headset_resolution, frame.timing.period, frame.timing.period);
    return {};
}

Status FrameLoop::present_mirror(gpu::FrameContext& recorded, VkExtent2D size) {
    const render::Renderer& renderer = *canvas_.gpu_context.renderer;
    MirrorSources sources;
    sources.eyes = {renderer.picture(0, immersive_group)};
    if (canvas_.mirrored_eyes > 1) sources.eyes.push_back(renderer.picture(1, immersive_group));
    sources.eye_size = size;
    sources.panel = content_.panel_picture();
    if (sources.panel) sources.panel_size = sources.panel->image->info().extent;
    const VkExtent2D window = canvas_.swapchain->plan().extent;
    const gpu::WindowPictures pictures{canvas_.swapchain.get(),
                                       mirror_pictures(content_.mirror(), sources, window), false};
    BOLT_TRY(gpu::present(*canvas_.gpu_context.frames, recorded, std::span(&pictures, 1)));
    return {};
}

Status FrameLoop::draw_late(WindowFrame window) {
    ImmersiveFrame& immersive = *canvas_.last_immersive;
    immersive.repeated = true;
    immersive.recentred = immersive.origin_moved = false;
    immersive.groups.clear();
    immersive.vibrate = {};
    window.immersive = &immersive;
    BOLT_TRY(content_.update(window));
    BOLT_TRY_ASSIGN(const auto recorded, canvas_.gpu_context.frames->begin());
    BOLT_TRY(content_.draw(*recorded, window));
    return canvas_.mirrored ? present_mirror(*recorded, *canvas_.mirrored)
                            : canvas_.gpu_context.frames->submit(*recorded);
}

// A frame on projection walls. The content's picture for the control window is shown whole; all windows are
// presented together.
Status FrameLoop::draw_walls(WindowFrame window) {
    Walls& walls = *options_.walls;
    GpuContext& gpu = canvas_.gpu_context;
    BOLT_TRY_ASSIGN(const ImmersiveFrame immersive, walls.begin_frame(canvas_.last_frame));
    window.immersive = &immersive;
    BOLT_TRY(content_.update(window));
    WallLeader* leader = walls.leader();
    if (leader != nullptr) {
        cluster::MessageWriter state, bulk;
        BOLT_TRY(content_.share(state, bulk));
        BOLT_TRY(walls.share(immersive, state.message(), bulk.message()));
    }
    BOLT_TRY_ASSIGN(const auto recorded, gpu.frames->begin());
    BOLT_TRY(content_.draw(*recorded, window));
    std::vector<gpu::WindowPictures> windows;
    if (window.size.width > 0 && window.size.height > 0) {
        const render::ImageLayer picture = content_.window_picture(*gpu.renderer);
        const VkRect2D place = fitted(picture.image->info().extent, window.size);
        windows.push_back({canvas_.swapchain.get(), {{picture.image, picture.layer, {}, place}}, false});
    }
    walls.add_pictures(*gpu.renderer, immersive, windows);
    if (leader == nullptr) {
        BOLT_TRY(gpu::present(*gpu.frames, *recorded, windows));
        return {};
    }
    // All processes present when all GPUs have finished, so that no wall lags behind the others.
    BOLT_TRY(gpu::present(*gpu.frames, *recorded, windows, [&]() -> Status {
        BOLT_TRY(gpu.device->idle());
        return walls.wait_for_others();
    }));
    leader->presented();
    return {};
}

// The headset's frame is begun when its runtime releases it, which paces the loop. If the runtime is late by
// more than a frame or two, lesson and window go on with the last poses; after `max_hitch` without the
// headset.
Status FrameLoop::draw() {
    static constexpr double max_wait = 1.0 / 30, late_wait = 1.0 / 60, max_hitch = 0.5;  // s
    BOLT_TRY_ASSIGN(const auto size, canvas_.swapchain->prepare(size_of(window_)));
    xr::Headset* headset = options_.headset;
    std::optional<xr::HeadsetFrame> headset_frame;
    const double wait = display() != Display::headset ? 0.0 : canvas_.late_since > 0.0 ? late_wait : max_wait;
    if (headset != nullptr) headset_frame = headset->begin_frame(wait);
    const double now = seconds();
    const bool late = headset != nullptr && headset->running() && !headset_frame;
    if (late && canvas_.late_since == 0.0) canvas_.late_since = now;
    if (!late) canvas_.late_since = 0.0;
    canvas_.hangs = late && now - canvas_.late_since >= max_hitch;
    if (!late && display() == Display::window) canvas_.last_immersive.reset();
    const double elapsed = now - canvas_.last_frame;
    canvas_.last_frame = now;
    const std::vector<platform::InputEvent> events = std::exchange(canvas_.events, {});
    const WindowFrame frame{events, size, window_.content_scale(), elapsed, nullptr};
    if (headset_frame && headset_frame->timing.should_render) return draw_headset(*headset_frame, frame);
    if (headset_frame) headset->end_frame(*headset_frame, false, immersive_range);
    if (display() == Display::walls) return draw_walls(frame);
    if (late && !canvas_.hangs && canvas_.last_immersive) return draw_late(frame);
    return minimised() ? content_.frame_while_hidden() : draw_window(frame);
}

bool FrameLoop::poll_events(bool only_minimised) {
    const std::vector<platform::InputEvent> polled =
        only_minimised ? window_.wait_for_events(0.1) : window_.poll_events();
    canvas_.events.insert(canvas_.events.end(), polled.begin(), polled.end());
    if (options_.walls != nullptr) {
        const std::vector<platform::InputEvent> more = options_.walls->poll_events();
        canvas_.events.insert(canvas_.events.end(), more.begin(), more.end());
    }
    const bool closed = std::any_of(polled.begin(), polled.end(), [](const platform::InputEvent& event) {
        return std::holds_alternative<platform::CloseEvent>(event);
    });
    return !(only_minimised && closed);
}

Result<Ending> FrameLoop::run() {
    platform::Pace pace{platform::Clock::now(), platform::period_of(refresh_rate()), 0};
    canvas_.last_frame = seconds();
    while (!content_.closed() && !(options_.stop && options_.stop())) {
        if (content_.wants_other_display()) return Ending::other_display;
        xr::Headset* headset = options_.headset;
        if (headset != nullptr && headset->find_in_background(seconds())) return Ending::headset_found;
        if (headset != nullptr && headset->exit_requested()) return Ending::closed;
        const Display shown = display();
        const bool open = poll_events(shown == Display::window && minimised());
        BOLT_TRY(window_.display_status());
        if (!open) return Ending::closed;
        if (Status done = draw(); !done) {
            // If the display server has ended, report that instead of the failed presentation.
            const Status server = window_.display_status();
            return fail(server ? done.error() : server.error());
        }
        if (content_.take_full_screen_request()) window_.set_full_screen(!window_.full_screen());
        if (shown != Display::headset) (void)platform::wait_for_deadline(pace);
    }
    return Ending::closed;
}

// Creates Vulkan's instance anew. The functions of Vulkan are loaded for one instance at a time, so the old
// one is destroyed first.
Status remake_instance(gpu::Instance& instance, const WindowRunOptions& options) {
    gpu::InstanceOptions again = options.instance;
    again.log = instance.shared_log();
    { const gpu::Instance ended = std::move(instance); }
    BOLT_TRY_ASSIGN(instance, make_instance(again, options.headset, options.needs_headset));
    return {};
}

// Runs the session of a headset that was found. Returns false if it cannot be used.
bool begin_headset(const WindowRunOptions& options, const Result<Canvas>& canvas) {
    xr::Headset& headset = *options.headset;
    if (canvas)
        headset.begin(*canvas->gpu_context.device);
    else
        headset.refuse(canvas.error());
    return headset.connected();
}

// Runs the content with one set of GPU objects.
Result<Ending> run_on_canvas(WindowContent& content, platform::Window& window, const gpu::Instance& instance,
                             WindowRunOptions& options) {
    Result<Canvas> made = make_canvas(window, instance, options);
    if (options.headset != nullptr && options.headset->creator() != nullptr &&
        !begin_headset(options, made)) {
        if (options.needs_headset) return fail(needed(*options.headset->absence()));
        if (!made) return Ending::headset_refused;
    }
    if (!made) return fail(made.error());
    options.needs_headset = false;
    Canvas& canvas = *made;
    Result<Ending> ending = Ending::closed;
    Status started =
        options.walls != nullptr ? options.walls->start(*canvas.gpu_context.device, instance) : Status{};
    if (started) started = content.start(canvas.gpu_context);
    if (started)
        ending = FrameLoop(content, canvas, window, options).run();
    else
        ending = fail(started.error());
    // A runtime that was just found has no session yet.
    if (options.headset != nullptr && (!ending || *ending != Ending::headset_found)) options.headset->end();
    content.release();
    if (options.walls != nullptr) options.walls->release();
    // Without the saved pipelines the next start is only slower.
    (void)canvas.gpu_context.renderer->save_pipelines();
    return ending;
}

}  // namespace

Result<gpu::Instance> make_instance(gpu::InstanceOptions instance_options, xr::Headset* headset,
                                    bool needs_headset) {
    instance_options.creator = headset != nullptr ? headset->creator() : nullptr;
    Result<gpu::Instance> made = gpu::Instance::create(instance_options);
    if (made || instance_options.creator == nullptr) return made;
    headset->refuse(made.error());
    if (needs_headset) return fail(needed(made.error()));
    instance_options.creator = nullptr;
    return gpu::Instance::create(instance_options);
}

Status run_in_window(WindowContent& content, platform::Window& window, gpu::Instance& instance,
                     WindowRunOptions options) {
    gpu::DeviceLossPolicy loss_policy;
    for (;;) {
        const Result<Ending> ending = run_on_canvas(content, window, instance, options);
        if (ending && *ending == Ending::other_display) return {};
        if (ending && *ending != Ending::closed) {
            BOLT_TRY(remake_instance(instance, options));
            continue;
        }
        if (ending || !ending.error().lost) {
            const Status ended = content.end();
            return ending ? ended : fail(ending.error());
        }
        if (!loss_policy.should_restart(seconds())) {
            (void)content.end();
            return fail(ErrorCode::no_device,
                        fmt::format("the GPU was lost twice within {:.0f} s: {}",
                                    gpu::DeviceLossPolicy::min_interval, ending.error().what),
                        "another GPU or driver: boltwright doctor lists them, --gpu chooses");
        }
        (void)std::fprintf(stderr, "the GPU was lost (%s) and is started again\n",
                           ending.error().what.c_str());
    }
}

}  // namespace bolt::view
