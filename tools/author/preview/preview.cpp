#include "tools/author/preview/preview.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "engine/base/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/pace.hpp"
#include "engine/render/renderer.hpp"
#include "game/view/pictures.hpp"
#include "tools/author/preview/hands.hpp"

namespace bolt::author {

void Sources::keep(view::Subject subject, view::Level level) {
    subject_ = std::move(subject);
    level_ = level;
    std::vector<std::filesystem::path> files = subject_.files;
    files.emplace_back(light_);  // "studio" is no file, and none that comes
    watch_.watch(std::move(files));
}

Sources::Changes Sources::changed(double now) {
    Changes changes;
    for (const std::filesystem::path& file : watch_.changed(now)) {
        if (file == light_)
            changes.light = true;
        else
            changes.subject = true;
    }
    return changes;
}

namespace {

constexpr double look_every = 0.1;   // s, at files
constexpr float level_error = 0.5F;  // px: coarser levels of detail while they look the same

double seconds() { return std::chrono::duration<double>(platform::Clock::now().time_since_epoch()).count(); }

float aspect_of(VkExtent2D size) {
    return size.height > 0 ? static_cast<float>(size.width) / static_cast<float>(size.height) : 1.0F;
}

// Everything on the GPU, in the order in which it stands on each other. What is drawn with is let go of only
// when nothing is being drawn.
struct OnGpu {
    view::Painter painter;
    std::unique_ptr<render::EnvironmentLight> light;
    std::unique_ptr<view::Stage> stage;
    std::unique_ptr<gpu::Swapchain> swapchain;  // none without a window

    OnGpu() = default;
    OnGpu(OnGpu&&) = default;
    OnGpu& operator=(OnGpu&&) = delete;
    ~OnGpu() {
        if (painter.device) (void)painter.device->idle();
    }
};

Result<OnGpu> put_on_gpu(const PreviewOptions& options, const Sources& sources, const gpu::Instance& instance,
                         const render::ShaderCode& shaders, VkSurfaceKHR surface) {
    OnGpu on;
    render::RendererOptions renderer;
    renderer.shaders = shaders;
    renderer.level_error_px = level_error;
    BOLT_TRY_ASSIGN(auto painter, view::make_painter(instance, {options.gpu, surface}, renderer));
    on.painter = std::move(painter);
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*on.painter.device, sources.radiance()));
    on.light = std::make_unique<render::EnvironmentLight>(std::move(light));
    BOLT_TRY_ASSIGN(auto stage,
                    view::set_stage(*on.painter.device, sources.subject(), *on.light, {true, true}));
    on.stage = std::move(stage);
    return on;
}

// Where the camera begins.
view::Orbit first_look(const PreviewOptions& options, const Sources& sources, const view::Stage& stage,
                       VkExtent2D size) {
    if (const auto named = view::named_view(sources.subject(), options.view); named)
        return view::orbit_of(*named);
    return view::orbit_of(view::framed(stage.box, view::usual_fov, aspect_of(size)));
}

Status no_messages(const gpu::Instance& instance) {
    if (instance.log().messages.empty()) return {};
    return fail(ErrorCode::failed, instance.log().messages.front());
}

class Show {
  public:
    Show(const PreviewOptions& options, Sources& sources, platform::Window& window,
         const gpu::Instance& instance)
        : options_(options), sources_(sources), window_(window), instance_(instance) {}

    Status run();

  private:
    Status start();
    Status until_closed();
    Status follow_files(bool all);
    Status take_subject(view::Level level);
    Status take_light();
    Status take_shaders(render::ShaderCode code);
    Status do_as_wished(const Wishes& wishes);
    Result<bool> draw();
    enum Part : std::uint8_t { of_subject, of_light, of_shaders };
    void tell(Part part, std::vector<Error> errors);
    void tell_messages();

    const PreviewOptions& options_;
    Sources& sources_;
    platform::Window& window_;
    const gpu::Instance& instance_;
    std::optional<render::HotShaders> hot_shaders_;
    render::ShaderCode shaders_;
    std::optional<OnGpu> on_;
    view::Glide camera_;
    Hands hands_;
    bool looked_ = false;  // the camera stands somewhere
    bool stale_ = true;    // the window shows something else than it should
    bool closed_ = false;
    double files_seen_ = 0.0;
    std::array<std::vector<Error>, 3> wrong_;  // by part
    std::size_t messages_told_ = 0;
};

[[nodiscard]] VkExtent2D size_of(const platform::Window& window) {
    const platform::Size size = window.pixels();
    return {size.width, size.height};
}

// What is wrong with a part, on the standard error and, until it is well again, in the title.
void Show::tell(Part part, std::vector<Error> errors) {
    (void)print_error(errors);
    wrong_[part] = std::move(errors);
    const std::string& name = sources_.subject().name;
    std::string title = fmt::format("{} - bolt-author preview", name);
    for (const std::vector<Error>& wrong : wrong_)
        if (!wrong.empty()) title = fmt::format("{} - broken: {}", name, wrong.front().message());
    window_.set_title(title.substr(0, title.find('\n')));
}

void Show::tell_messages() {
    const std::vector<std::string>& messages = instance_.log().messages;
    for (; messages_told_ < messages.size(); ++messages_told_)
        (void)std::fprintf(stderr, "%s\n", messages[messages_told_].c_str());
}

Status Show::start() {
    const gpu::MakeSurface make_surface = [this] { return window_.make_surface(instance_); };
    BOLT_TRY_ASSIGN(auto surface, make_surface());
    BOLT_TRY_ASSIGN(auto on, put_on_gpu(options_, sources_, instance_, shaders_, surface.get()));
    on_.emplace(std::move(on));
    BOLT_TRY_ASSIGN(auto swapchain,
                    gpu::Swapchain::create(*on_->painter.device, std::move(surface), make_surface));
    on_->swapchain = std::move(swapchain);
    if (!std::exchange(looked_, true))
        camera_.jump(first_look(options_, sources_, *on_->stage, size_of(window_)));
    stale_ = true;
    return {};
}

Status Show::take_subject(view::Level level) {
    view::LoadedSubject loaded = sources_.read_subject(level);
    if (!loaded.ok()) {
        tell(of_subject, std::move(loaded.errors));
        return {};
    }
    auto stage = view::set_stage(*on_->painter.device, loaded.subject, *on_->light, {true, true});
    if (!stage && stage.error().lost) return fail(stage.error());
    if (!stage) {
        tell(of_subject, {stage.error()});
        return {};
    }
    BOLT_TRY(on_->painter.device->idle());
    on_->stage = std::move(*stage);
    stale_ = true;
    sources_.keep(std::move(loaded.subject), level);
    tell(of_subject, {});
    return print(fmt::format("read {} again\n", sources_.subject().name));
}

Status Show::take_light() {
    Result<shading::RadianceImage> read = sources_.read_light();
    if (!read) {
        tell(of_light, {read.error()});
        return {};
    }
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*on_->painter.device, *read));
    BOLT_TRY(on_->painter.device->idle());
    *on_->light = std::move(light);
    stale_ = true;
    sources_.keep(std::move(*read));
    tell(of_light, {});
    return {};
}

// A renderer with the new shaders has to draw a small picture before it takes the place of the old one: many
// pipelines are made by the first picture only.
Status Show::take_shaders(render::ShaderCode code) {
    render::RendererOptions options;
    options.shaders = code;
    options.level_error_px = level_error;
    gpu::Device& device = *on_->painter.device;
    const auto draws = [&](render::Renderer& renderer) -> Status {
        const render::Eye eye = view::eye_of(camera_.shown, on_->stage->box, 1.0F);
        BOLT_TRY(render::take_pictures(device, *on_->painter.frames, renderer, on_->stage->scene,
                                       std::span(&eye, 1), {32, 32}));
        return {};
    };
    auto renderer = render::Renderer::create(device, options);
    const Status good = renderer ? draws(**renderer) : Status(fail(renderer.error()));
    if (!good && good.error().lost) return good;
    BOLT_TRY(device.idle());
    if (!good) {
        tell(of_shaders, {good.error()});
        return {};
    }
    on_->painter.renderer = std::move(*renderer);
    shaders_ = std::move(code);
    stale_ = true;
    tell(of_shaders, {});
    return {};
}

Status Show::follow_files(bool all) {
    const double now = seconds();
    if (!all && now - files_seen_ < look_every) return {};
    files_seen_ = now;
    const Sources::Changes changes = sources_.changed(now);
    if (changes.light || all) BOLT_TRY(take_light());
    if (changes.subject || all) BOLT_TRY(take_subject(sources_.level()));
    if (!hot_shaders_) return {};
    std::optional<Result<render::ShaderCode>> code = hot_shaders_->changed(now);
    if (!code) return {};
    if (*code) return take_shaders(std::move(**code));
    tell(of_shaders, {code->error()});
    return {};
}

Status Show::do_as_wished(const Wishes& wishes) {
    closed_ = closed_ || wishes.close;
    stale_ = stale_ || wishes.redraw;
    if (wishes.full_screen) window_.set_full_screen(!window_.full_screen());
    const std::vector<view::Viewpoint>& views = sources_.subject().views;
    if (wishes.view && *wishes.view < views.size()) camera_.go(view::orbit_of(views[*wishes.view]));
    if (wishes.all) camera_.go(view::framing(camera_.goal, on_->stage->box, aspect_of(size_of(window_))));
    if (wishes.other_level) {
        const bool near = sources_.level() == view::Level::near;
        BOLT_TRY(take_subject(near ? view::Level::far : view::Level::near));
    }
    return follow_files(wishes.reload);
}

// False: there was nothing to show it on.
Result<bool> Show::draw() {
    BOLT_TRY_ASSIGN(const auto size, on_->swapchain->ready(size_of(window_)));
    if (size.width == 0 || size.height == 0) return false;
    BOLT_TRY_ASSIGN(const auto frame, on_->painter.frames->begin());
    const render::Eye eye = view::eye_of(camera_.shown, on_->stage->box, aspect_of(size));
    render::Renderer& renderer = *on_->painter.renderer;
    BOLT_TRY(renderer.render(*frame, on_->stage->scene, std::span(&eye, 1), size));
    const render::ImageLayer picture = renderer.picture(0);
    return on_->swapchain->show(*on_->painter.frames, *frame, *picture.image, picture.layer);
}

Status Show::until_closed() {
    platform::Pace pace{platform::Clock::now(), platform::period_of(window_.refresh()), 0};
    double last = seconds();
    bool resting = false;  // nothing moves: sleep until something happens
    while (!closed_) {
        const VkExtent2D size = size_of(window_);
        const std::vector<platform::Event> events =
            resting ? window_.wait_for_events(look_every) : window_.events();
        const Wishes wishes =
            hands_.apply(events, std::max(size.height, 1U), static_cast<double>(aspect_of(size)),
                         camera_.goal, on_->stage->box);
        BOLT_TRY(do_as_wished(wishes));
        // After a rest, time begins with this frame.
        const double now = seconds(), passed = resting ? pace.period : now - last;
        last = now;
        const bool moved = camera_.advance(passed);
        if (!moved && !stale_) {
            resting = true;
            continue;
        }
        if (resting) pace = {platform::Clock::now(), platform::period_of(window_.refresh()), 0};
        BOLT_TRY_ASSIGN(const auto shown, draw());
        stale_ = !shown;
        resting = on_->swapchain->plan().extent.width == 0;
        tell_messages();
        if (!resting) (void)platform::wait_for_deadline(pace);
    }
    return {};
}

Status Show::run() {
    if (!options_.shaders.empty()) {
        BOLT_TRY_ASSIGN(auto hot, render::HotShaders::open(options_.shaders));
        hot_shaders_.emplace(std::move(hot));
    }
    tell(of_subject, {});
    BOLT_TRY(print(help(sources_.subject().views)));
    gpu::DeviceLossPolicy loss_policy;
    for (;;) {
        Status done = start();
        if (done) done = until_closed();
        on_.reset();
        tell_messages();
        if (done) return no_messages(instance_);
        if (!done.error().lost) return done;
        if (!loss_policy.should_restart(seconds()))
            return fail(ErrorCode::no_device,
                        fmt::format("the GPU was lost twice within {:.0f} s: {}",
                                    gpu::DeviceLossPolicy::min_interval, done.error().what),
                        "another GPU or driver: boltwright doctor lists them, --gpu chooses");
        (void)std::fprintf(stderr, "the GPU was lost (%s) and is started again\n", done.error().what.c_str());
    }
}

}  // namespace

Status show_preview(const PreviewOptions& options, Sources& sources, platform::Window& window,
                    const gpu::Instance& instance) {
    return Show(options, sources, window, instance).run();
}

Status draw_preview(const PreviewOptions& options, const Sources& sources, const gpu::Instance& instance) {
    render::ShaderCode shaders;
    if (!options.shaders.empty()) {
        BOLT_TRY_ASSIGN(auto hot, render::HotShaders::open(options.shaders));
        std::optional<Result<render::ShaderCode>> code = hot.changed(seconds());
        if (code && !*code) return fail(code->error());
        if (code) shaders = std::move(**code);
    }
    BOLT_TRY_ASSIGN(const auto on, put_on_gpu(options, sources, instance, shaders, VK_NULL_HANDLE));
    const view::Orbit look = first_look(options, sources, *on.stage, options.size);
    const render::Eye eye = view::eye_of(look, on.stage->box, aspect_of(options.size));
    BOLT_TRY_ASSIGN(const auto pictures,
                    render::take_pictures(*on.painter.device, *on.painter.frames, *on.painter.renderer,
                                          on.stage->scene, std::span(&eye, 1), options.size));
    BOLT_TRY(view::write_picture(pictures.front(), options.png));
    return no_messages(instance);
}

}  // namespace bolt::author
