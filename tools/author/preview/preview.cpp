#include "tools/author/preview/preview.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "engine/base/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/swapchain.hpp"
#include "engine/platform/pace.hpp"
#include "engine/render/renderer.hpp"
#include "game/view/gpu_context.hpp"
#include "game/view/pictures.hpp"
#include "tools/author/preview/controls.hpp"
#include "tools/author/preview/joint_selection.hpp"

namespace bolt::author {

void PreviewSources::set_shown(view::LoadedModel model, view::DetailLevel level) {
    model_ = std::move(model);
    level_ = level;
    std::vector<std::filesystem::path> files = model_.files;
    files.emplace_back(light_);  // harmless for "studio", which is not a file
    watch_.watch(std::move(files));
}

PreviewSources::FileChanges PreviewSources::poll_changes(double now) {
    FileChanges changes;
    for (const std::filesystem::path& file : watch_.changed(now)) {
        if (file == light_)
            changes.light = true;
        else
            changes.model = true;
    }
    return changes;
}

namespace {

constexpr double poll_interval = 0.1;  // s, between checks of the files
constexpr float level_error = 0.5F;    // px, largest visible error of a coarser level of detail
constexpr glm::vec4 selected_color{1.0F, 0.78F, 0.1F, 1.0F};

double seconds() { return std::chrono::duration<double>(platform::Clock::now().time_since_epoch()).count(); }

float aspect_of(VkExtent2D size) {
    return size.height > 0 ? static_cast<float>(size.width) / static_cast<float>(size.height) : 1.0F;
}

// All GPU objects; each member depends on those above it. The destructor waits until the GPU is idle before
// it releases them.
struct GpuState {
    view::GpuContext gpu_context;
    std::unique_ptr<render::EnvironmentLight> light;
    std::unique_ptr<view::ShownModel> shown_model;
    std::unique_ptr<gpu::Swapchain> swapchain;  // null without a window

    GpuState() = default;
    GpuState(GpuState&&) = default;
    GpuState& operator=(GpuState&&) = delete;
    ~GpuState() {
        if (gpu_context.device) (void)gpu_context.device->idle();
    }
};

Result<GpuState> upload(const PreviewOptions& options, const PreviewSources& sources,
                        const gpu::Instance& instance, const render::ShaderCode& shaders,
                        VkSurfaceKHR surface) {
    GpuState state;
    render::RendererOptions renderer;
    renderer.shaders = shaders;
    renderer.level_error_px = level_error;
    BOLT_TRY_ASSIGN(auto gpu_context, view::make_gpu_context(instance, {options.gpu, surface}, renderer));
    state.gpu_context = std::move(gpu_context);
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*state.gpu_context.device, sources.radiance()));
    state.light = std::make_unique<render::EnvironmentLight>(std::move(light));
    BOLT_TRY_ASSIGN(auto shown_model,
                    view::show_model(*state.gpu_context.device, sources.model(), *state.light, {true, true}));
    state.shown_model = std::move(shown_model);
    return state;
}

// The camera of the first picture: the named view, or one that shows the whole model.
view::Orbit initial_camera(const PreviewOptions& options, const PreviewSources& sources,
                           const view::ShownModel& shown_model, VkExtent2D size) {
    if (const auto named = view::named_view(sources.model(), options.view); named)
        return view::orbit_of(*named);
    return view::orbit_of(view::default_viewpoint(shown_model.box, view::default_fov, aspect_of(size)));
}

// Fails if the validation layers reported a message.
Status check_messages(const gpu::Instance& instance) {
    if (instance.log().messages.empty()) return {};
    return fail(ErrorCode::failed, instance.log().messages.front());
}

// The preview in a window: draws, polls the files and restarts after a lost GPU.
class PreviewSession {
  public:
    PreviewSession(const PreviewOptions& options, PreviewSources& sources, platform::Window& window,
                   const gpu::Instance& instance)
        : options_(options), sources_(sources), window_(window), instance_(instance) {}

    Status run();

  private:
    Status start();
    Status run_until_closed();
    Status follow_files(bool all);
    Status reload_model(view::DetailLevel level);
    Status reload_light();
    Status reload_shaders(render::ShaderCode code);
    Status execute(const PreviewCommands& commands);
    Status select_joint(const SelectableJoint* joint);
    Status follow_selection();
    void outline_selection(const glm::vec4& color);
    Result<bool> draw();
    enum Source : std::uint8_t { model_source, light_source, shader_source };
    void report_errors(Source source, std::vector<Error> errors);
    void update_title();
    void print_messages();

    const PreviewOptions& options_;
    PreviewSources& sources_;
    platform::Window& window_;
    const gpu::Instance& instance_;
    std::optional<render::HotShaders> hot_shaders_;
    render::ShaderCode shaders_;
    std::optional<GpuState> gpu_;
    view::CameraGlide camera_;
    PreviewControls controls_;
    SelectableJoints joints_;
    std::optional<SelectableJoint> selected_;
    bool camera_placed_ = false;  // false until the first picture
    bool needs_redraw_ = true;    // the picture in the window is out of date
    bool closed_ = false;
    double files_polled_at_ = 0.0;
    std::array<std::vector<Error>, 3> errors_;  // by Source
    std::size_t messages_printed_ = 0;
};

[[nodiscard]] VkExtent2D size_of(const platform::Window& window) {
    const platform::Size size = window.pixels();
    return {size.width, size.height};
}

// Prints the errors of a source to stderr and keeps them for the title.
void PreviewSession::report_errors(Source source, std::vector<Error> errors) {
    (void)print_error(errors);
    errors_[source] = std::move(errors);
    update_title();
}

// Shows the first error of any source until it is fixed; without an error the selected joint.
void PreviewSession::update_title() {
    const std::string& name = sources_.model().name;
    std::string title = fmt::format("{} - bolt-author preview", name);
    if (selected_)
        title = fmt::format("{} - joint {}: {} - {} - bolt-author preview", name, selected_->id,
                            selected_->description, selected_->location);
    for (const std::vector<Error>& list : errors_)
        if (!list.empty()) title = fmt::format("{} - error: {}", name, list.front().message());
    window_.set_title(title.substr(0, title.find('\n')));
}

// Alpha 0 removes the outline. A joint without a drawn part is not outlined.
void PreviewSession::outline_selection(const glm::vec4& color) {
    if (selected_) (void)view::outline(*gpu_->shown_model, sources_.model(), selected_->node, color);
    needs_redraw_ = true;
}

// `joint`: null clears the selection.
Status PreviewSession::select_joint(const SelectableJoint* joint) {
    outline_selection(glm::vec4(0.0F));
    selected_ = joint == nullptr ? std::nullopt : std::optional(*joint);
    outline_selection(selected_color);
    update_title();
    return selected_ ? print(selection_line(*selected_)) : Status();
}

// Finds the selected joint in the files that were just reloaded.
Status PreviewSession::follow_selection() {
    if (!selected_) return {};
    const SelectableJoint* joint = joint_named(joints_, selected_->id);
    if (joint == nullptr) {
        const std::string line = fmt::format("joint {} has gone and is no longer selected\n", selected_->id);
        selected_.reset();
        update_title();
        return print(line);
    }
    const bool same = selection_line(*joint) == selection_line(*selected_);
    selected_ = *joint;
    outline_selection(selected_color);
    update_title();
    return same ? Status() : print(selection_line(*joint));
}

void PreviewSession::print_messages() {
    const std::vector<std::string>& messages = instance_.log().messages;
    for (; messages_printed_ < messages.size(); ++messages_printed_)
        (void)std::fprintf(stderr, "%s\n", messages[messages_printed_].c_str());
}

Status PreviewSession::start() {
    const gpu::MakeSurface make_surface = [this] { return window_.make_surface(instance_); };
    BOLT_TRY_ASSIGN(auto surface, make_surface());
    BOLT_TRY_ASSIGN(auto state, upload(options_, sources_, instance_, shaders_, surface.get()));
    gpu_.emplace(std::move(state));
    BOLT_TRY_ASSIGN(auto swapchain,
                    gpu::Swapchain::create(*gpu_->gpu_context.device, std::move(surface), make_surface));
    gpu_->swapchain = std::move(swapchain);
    if (!std::exchange(camera_placed_, true))
        camera_.jump(initial_camera(options_, sources_, *gpu_->shown_model, size_of(window_)));
    outline_selection(selected_color);
    return {};
}

Status PreviewSession::reload_model(view::DetailLevel level) {
    view::ModelLoadResult loaded = sources_.read_model(level);
    if (!loaded.ok()) {
        report_errors(model_source, std::move(loaded.errors));
        return {};
    }
    Result<SelectableJoints> joints = find_joints(options_.source, loaded.model);
    if (!joints) {
        report_errors(model_source, {joints.error()});
        return {};
    }
    auto shown_model = view::show_model(*gpu_->gpu_context.device, loaded.model, *gpu_->light, {true, true});
    if (!shown_model && shown_model.error().lost) return fail(shown_model.error());
    if (!shown_model) {
        report_errors(model_source, {shown_model.error()});
        return {};
    }
    BOLT_TRY(gpu_->gpu_context.device->idle());
    gpu_->shown_model = std::move(*shown_model);
    needs_redraw_ = true;
    sources_.set_shown(std::move(loaded.model), level);
    joints_ = std::move(*joints);
    report_errors(model_source, {});
    BOLT_TRY(print(fmt::format("reloaded {}\n", sources_.model().name)));
    return follow_selection();
}

Status PreviewSession::reload_light() {
    Result<shading::RadianceImage> read = sources_.read_light();
    if (!read) {
        report_errors(light_source, {read.error()});
        return {};
    }
    BOLT_TRY_ASSIGN(auto light, render::upload_environment(*gpu_->gpu_context.device, *read));
    BOLT_TRY(gpu_->gpu_context.device->idle());
    *gpu_->light = std::move(light);
    needs_redraw_ = true;
    sources_.set_shown(std::move(*read));
    report_errors(light_source, {});
    return {};
}

// Replaces the renderer only after the new one has drawn a small picture, because many pipelines are created
// by the first picture.
Status PreviewSession::reload_shaders(render::ShaderCode code) {
    render::RendererOptions options;
    options.shaders = code;
    options.level_error_px = level_error;
    gpu::Device& device = *gpu_->gpu_context.device;
    const auto test_draw = [&](render::Renderer& renderer) -> Status {
        const render::Eye eye = view::eye_of(camera_.shown, gpu_->shown_model->box, 1.0F);
        BOLT_TRY(render::take_pictures(device, *gpu_->gpu_context.frames, renderer, gpu_->shown_model->scene,
                                       std::span(&eye, 1), {32, 32}));
        return {};
    };
    auto renderer = render::Renderer::create(device, options);
    const Status drawn = renderer ? test_draw(**renderer) : Status(fail(renderer.error()));
    if (!drawn && drawn.error().lost) return drawn;
    BOLT_TRY(device.idle());
    if (!drawn) {
        report_errors(shader_source, {drawn.error()});
        return {};
    }
    gpu_->gpu_context.renderer = std::move(*renderer);
    shaders_ = std::move(code);
    needs_redraw_ = true;
    report_errors(shader_source, {});
    return {};
}

Status PreviewSession::follow_files(bool all) {
    const double now = seconds();
    if (!all && now - files_polled_at_ < poll_interval) return {};
    files_polled_at_ = now;
    const PreviewSources::FileChanges changes = sources_.poll_changes(now);
    if (changes.light || all) BOLT_TRY(reload_light());
    if (changes.model || all) BOLT_TRY(reload_model(sources_.level()));
    if (!hot_shaders_) return {};
    std::optional<Result<render::ShaderCode>> code = hot_shaders_->changed(now);
    if (!code) return {};
    if (*code) return reload_shaders(std::move(**code));
    report_errors(shader_source, {code->error()});
    return {};
}

Status PreviewSession::execute(const PreviewCommands& commands) {
    closed_ = closed_ || commands.close;
    needs_redraw_ = needs_redraw_ || commands.redraw;
    if (commands.full_screen) window_.set_full_screen(!window_.full_screen());
    const std::vector<view::Viewpoint>& views = sources_.model().views;
    if (commands.select_view && *commands.select_view < views.size())
        camera_.glide_to(view::orbit_of(views[*commands.select_view]));
    if (commands.show_all)
        camera_.glide_to(view::fit_to_box(camera_.goal, gpu_->shown_model->box, aspect_of(size_of(window_))));
    if (commands.click) {
        const VkExtent2D size = size_of(window_);
        const double height = std::max(size.height, 1U);
        const glm::dvec2 at = (*commands.click - 0.5 * glm::dvec2(size.width, height)) / height;
        BOLT_TRY(select_joint(joint_at(joints_, camera_.shown, {at.x, -at.y})));
    }
    if (commands.toggle_level) {
        const bool near = sources_.level() == view::DetailLevel::near;
        BOLT_TRY(reload_model(near ? view::DetailLevel::far : view::DetailLevel::near));
    }
    return follow_files(commands.reload);
}

// Returns false if the window has no area to draw on.
Result<bool> PreviewSession::draw() {
    BOLT_TRY_ASSIGN(const auto size, gpu_->swapchain->prepare(size_of(window_)));
    if (size.width == 0 || size.height == 0) return false;
    BOLT_TRY_ASSIGN(const auto frame, gpu_->gpu_context.frames->begin());
    const render::Eye eye = view::eye_of(camera_.shown, gpu_->shown_model->box, aspect_of(size));
    render::Renderer& renderer = *gpu_->gpu_context.renderer;
    BOLT_TRY(renderer.render(*frame, gpu_->shown_model->scene, std::span(&eye, 1), size));
    const render::ImageLayer picture = renderer.picture(0);
    return gpu_->swapchain->present(*gpu_->gpu_context.frames, *frame,
                                    {picture.image, picture.layer, {}, {}});
}

Status PreviewSession::run_until_closed() {
    platform::Pace pace{platform::Clock::now(), platform::period_of(window_.refresh_rate()), 0};
    double last = seconds();
    bool resting = false;  // nothing moves: wait for events instead of drawing
    while (!closed_) {
        const VkExtent2D size = size_of(window_);
        const std::vector<platform::InputEvent> events =
            resting ? window_.wait_for_events(poll_interval) : window_.poll_events();
        const PreviewCommands commands =
            controls_.apply(events, std::max(size.height, 1U), static_cast<double>(aspect_of(size)),
                            camera_.goal, gpu_->shown_model->box);
        BOLT_TRY(execute(commands));
        // The first frame after a rest takes one period, not the time that has passed.
        const double now = seconds(), passed = resting ? pace.period : now - last;
        last = now;
        const bool moved = camera_.advance(passed);
        if (!moved && !needs_redraw_) {
            resting = true;
            continue;
        }
        if (resting) pace = {platform::Clock::now(), platform::period_of(window_.refresh_rate()), 0};
        BOLT_TRY_ASSIGN(const auto shown, draw());
        needs_redraw_ = !shown;
        resting = gpu_->swapchain->plan().extent.width == 0;
        print_messages();
        if (!resting) (void)platform::wait_for_deadline(pace);
    }
    return {};
}

Status PreviewSession::run() {
    if (!options_.shaders.empty()) {
        BOLT_TRY_ASSIGN(auto hot, render::HotShaders::open(options_.shaders));
        hot_shaders_.emplace(std::move(hot));
    }
    BOLT_TRY_ASSIGN(joints_, find_joints(options_.source, sources_.model()));
    report_errors(model_source, {});
    BOLT_TRY(print(help_line(sources_.model().views)));
    gpu::DeviceLossPolicy loss_policy;
    for (;;) {
        Status done = start();
        if (done) done = run_until_closed();
        gpu_.reset();
        print_messages();
        if (done) return check_messages(instance_);
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

Status show_preview(const PreviewOptions& options, PreviewSources& sources, platform::Window& window,
                    const gpu::Instance& instance) {
    return PreviewSession(options, sources, window, instance).run();
}

Status draw_preview(const PreviewOptions& options, const PreviewSources& sources,
                    const gpu::Instance& instance) {
    render::ShaderCode shaders;
    if (!options.shaders.empty()) {
        BOLT_TRY_ASSIGN(auto hot, render::HotShaders::open(options.shaders));
        std::optional<Result<render::ShaderCode>> code = hot.changed(seconds());
        if (code && !*code) return fail(code->error());
        if (code) shaders = std::move(**code);
    }
    BOLT_TRY_ASSIGN(const auto state, upload(options, sources, instance, shaders, VK_NULL_HANDLE));
    const view::Orbit camera = initial_camera(options, sources, *state.shown_model, options.size);
    const render::Eye eye = view::eye_of(camera, state.shown_model->box, aspect_of(options.size));
    BOLT_TRY_ASSIGN(const auto pictures,
                    render::take_pictures(*state.gpu_context.device, *state.gpu_context.frames,
                                          *state.gpu_context.renderer, state.shown_model->scene,
                                          std::span(&eye, 1), options.size));
    BOLT_TRY(view::write_picture(pictures.front(), options.png));
    return check_messages(instance);
}

}  // namespace bolt::author
