#include "tools/author/preview/preview_session.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "engine/base/result.hpp"
#include "engine/base/steady_seconds.hpp"
#include "engine/platform/pace.hpp"

namespace bolt::author {

namespace {

constexpr double poll_interval = 0.1;  // s, between checks of the files

}  // namespace

VkExtent2D PreviewSession::window_size() const {
    const platform::Size size = window_.pixels();
    return {size.width, size.height};
}

// Prints the errors of a source to stderr and keeps them for the title.
void PreviewSession::report_errors(Source source, std::vector<Error> errors) {
    (void)print_error(errors);
    errors_[source] = std::move(errors);
    update_title();
}

// Shows the first error of any source until it is fixed; without an error the selected joint, or the number
// of problems.
void PreviewSession::update_title() {
    const std::string& name = sources_.model().name;
    const std::size_t problems = overlay_.problems().size();
    std::string title = fmt::format("{} - bolt-author preview", name);
    if (problems > 0)
        title =
            fmt::format("{} - {} problem{} - bolt-author preview", name, problems, problems == 1 ? "" : "s");
    if (selected_)
        title = fmt::format("{} - joint {}: {} - {} - bolt-author preview", name, selected_->id,
                            selected_->description, selected_->location);
    for (const std::vector<Error>& list : errors_)
        if (!list.empty()) title = fmt::format("{} - error: {}", name, list.front().message());
    window_.set_title(title.substr(0, title.find('\n')));
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
        camera_.jump(initial_camera(options_, sources_, *gpu_->shown_model, window_size()));
    outline_selection(true);
    BOLT_TRY(panel_.start(*gpu_->gpu_context.device));
    return prepare_overlay();
}

Status PreviewSession::reload_model(view::DetailLevel level, const std::string& variant) {
    view::ModelLoadResult loaded = sources_.read_model(level, variant);
    if (!loaded.ok()) {
        report_errors(model_source, std::move(loaded.errors));
        return {};
    }
    Result<SelectableJoints> joints = find_joints(options_.source, variant, loaded.model);
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
    const bool only_level = level != sources_.level();
    sources_.set_shown(std::move(loaded.model), level, variant);
    joints_ = std::move(*joints);
    if (!only_level) start_check();
    BOLT_TRY(prepare_overlay());
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
    const double now = steady_seconds();
    if (!all && now - files_polled_at_ < poll_interval) return {};
    files_polled_at_ = now;
    const PreviewSources::FileChanges changes = sources_.poll_changes(now);
    if (changes.light || all) BOLT_TRY(reload_light());
    if (changes.model || all) BOLT_TRY(reload_model(sources_.level(), sources_.variant()));
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
        camera_.glide_to(view::fit_to_box(camera_.goal, gpu_->shown_model->box, aspect_of(window_size())));
    if (commands.click) BOLT_TRY(follow_click(*commands.click));
    const PreviewPanelCommands clicked = panel_.take_commands();
    if (commands.toggle_sectors || clicked.toggle_sectors) {
        all_sectors_ = !all_sectors_;
        BOLT_TRY(prepare_overlay());
    }
    if (commands.toggle_panel) {
        panel_.toggle();
        needs_redraw_ = true;
    }
    const std::size_t problems = overlay_.problems().size();
    if (clicked.problem && *clicked.problem < problems)
        BOLT_TRY(choose_problem(*clicked.problem));
    else if (commands.next_problem && problems > 0)
        BOLT_TRY(choose_problem(next_problem_ % problems));
    if (clicked.variant) BOLT_TRY(choose_variant(*clicked.variant));
    if (commands.next_variant && !joints_.variants.empty()) {
        const auto at = std::find(joints_.variants.begin(), joints_.variants.end(), joints_.variant);
        BOLT_TRY(choose_variant(static_cast<std::size_t>(at - joints_.variants.begin() + 1) %
                                joints_.variants.size()));
    }
    if (commands.toggle_level) {
        const bool near = sources_.level() == view::DetailLevel::near;
        BOLT_TRY(reload_model(near ? view::DetailLevel::far : view::DetailLevel::near, sources_.variant()));
    }
    BOLT_TRY(follow_files(commands.reload));
    return poll_check();
}

// Returns false if the window has no area to draw on.
Result<bool> PreviewSession::draw() {
    BOLT_TRY_ASSIGN(const auto size, gpu_->swapchain->prepare(window_size()));
    if (size.width == 0 || size.height == 0) return false;
    BOLT_TRY_ASSIGN(const auto frame, gpu_->gpu_context.frames->begin());
    const auto see = [&](const render::BoundingBox& box) {
        return view::eye_of(camera_.shown, box, aspect_of(size));
    };
    render::Scene scene = gpu_->shown_model->scene;
    overlay_.add_to(scene, see(gpu_->shown_model->box), glm::vec2(size.width, size.height));
    const render::Eye eye = see(render::bounds(scene));
    render::Renderer& renderer = *gpu_->gpu_context.renderer;
    BOLT_TRY(renderer.render(*frame, scene, std::span(&eye, 1), size));
    BOLT_TRY(panel_.draw(*frame, renderer,
                         {overlay_, check_, joints_.variants, joints_.variant,
                          selected_ ? selected_->id : std::string(), all_sectors_}));
    const render::ImageLayer picture = renderer.picture(0);
    return gpu_->swapchain->present(*gpu_->gpu_context.frames, *frame,
                                    {picture.image, picture.layer, {}, {}});
}

Status PreviewSession::run_until_closed() {
    platform::Pace pace{platform::Clock::now(), platform::period_of(window_.refresh_rate()), 0};
    double last = steady_seconds();
    bool resting = false;  // nothing moves: wait for events instead of drawing
    while (!closed_) {
        const VkExtent2D size = window_size();
        std::vector<platform::InputEvent> events =
            resting ? window_.wait_for_events(poll_interval) : window_.poll_events();
        if (!sources_.model().without_assembly &&
            panel_.take_events(events, glm::vec2(size.width, size.height), window_.content_scale()))
            needs_redraw_ = true;
        const PreviewCommands commands =
            controls_.apply(events, std::max(size.height, 1U), static_cast<double>(aspect_of(size)),
                            camera_.goal, gpu_->shown_model->box);
        BOLT_TRY(execute(commands));
        // The first frame after a rest takes one period, not the time that has passed.
        const double now = steady_seconds(), passed = resting ? pace.period : now - last;
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
    BOLT_TRY_ASSIGN(joints_, find_joints(options_.source, sources_.variant(), sources_.model()));
    report_errors(model_source, {});
    start_check();
    BOLT_TRY(print(help_line(sources_.model().views)));
    gpu::DeviceLossPolicy loss_policy;
    for (;;) {
        Status done = start();
        if (done) done = run_until_closed();
        if (gpu_) (void)gpu_->gpu_context.device->idle();
        overlay_.release();
        panel_.release();
        gpu_.reset();
        print_messages();
        if (done) return check_messages(instance_);
        if (!done.error().lost) return done;
        if (!loss_policy.should_restart(steady_seconds()))
            return fail(ErrorCode::no_device,
                        fmt::format("the GPU was lost twice within {:.0f} s: {}",
                                    gpu::DeviceLossPolicy::min_interval, done.error().what),
                        "another GPU or driver: boltwright doctor lists them, --gpu chooses");
        (void)std::fprintf(stderr, "the GPU was lost (%s) and is started again\n", done.error().what.c_str());
    }
}

}  // namespace bolt::author
