#include "game/viewer/viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "engine/gpu/resources.hpp"
#include "game/trainer/controls.hpp"
#include "game/view/pictures.hpp"

namespace bolt::viewer {

namespace {

constexpr float text_size = 14.0F;        // points
constexpr double key_step = 2.0;          // s
constexpr double longest_frame = 0.25;    // s
constexpr std::uint32_t saved_group = 3;  // of the renderer's pictures: the picture to save
constexpr VkExtent2D saved_size{1920, 1080};

}  // namespace

struct Viewer::GpuResources {
    view::GpuContext* context = nullptr;
    std::unique_ptr<ui::Ui> ui;
    std::optional<film::ReplayScene> replay;
};

Viewer::Viewer(std::unique_ptr<Recording> recording, ViewerOptions options, scene::LessonModels models)
    : recording_(std::move(recording)), options_(std::move(options)), models_(std::move(models)) {
    seek(options_.at);
}
Viewer::~Viewer() = default;

Result<std::unique_ptr<Viewer>> Viewer::create(std::unique_ptr<Recording> recording, ViewerOptions options) {
    BOLT_TRY_ASSIGN(auto models, scene::load_lesson_models(recording->start.assembly, options.hand));
    std::unique_ptr<Viewer> viewer(new Viewer(std::move(recording), std::move(options), std::move(models)));
    const std::vector<view::Viewpoint>& views = viewer->models_.workpiece.views;
    viewer->camera_.jump(view::orbit_of(views.empty() ? view::Viewpoint{} : views.front()));
    return viewer;
}

Status Viewer::start(view::GpuContext& gpu_context) {
    gpu_ = std::make_unique<GpuResources>();
    gpu_->context = &gpu_context;
    BOLT_TRY_ASSIGN(auto ui, ui::Ui::create(*gpu_context.device, {text_size}));
    gpu_->ui = std::move(ui);
    for (const std::string& text : options_.words.texts) gpu_->ui->add_characters(text);
    BOLT_TRY_ASSIGN(auto replay,
                    film::make_replay_scene(*gpu_context.device, models_, recording_->start, options_.hand));
    gpu_->replay.emplace(std::move(replay));
    return {};
}

void Viewer::release() {
    if (gpu_ && gpu_->context->device) (void)gpu_->context->device->idle();
    if (picture_ == SavedPicture::drawn) picture_ = SavedPicture::requested;  // it was lost with the GPU
    gpu_.reset();
}

void Viewer::seek(double time) { time_ = std::clamp(time, 0.0, recording_->duration()); }

// At the end of the session, playing starts at the beginning.
void Viewer::toggle_playing() {
    if (!playing_ && time_ >= recording_->duration()) seek(0.0);
    playing_ = !playing_;
}

void Viewer::change_speed(int by) {
    const auto at = std::find(offered_speeds.begin(), offered_speeds.end(), speed_);
    const auto number =
        std::clamp<std::ptrdiff_t>(at - offered_speeds.begin() + by, 0, std::ssize(offered_speeds) - 1);
    speed_ = offered_speeds[static_cast<std::size_t>(number)];
}

void Viewer::show_view(std::size_t number) {
    const std::vector<view::Viewpoint>& views = models_.workpiece.views;
    if (number >= views.size()) return;
    follows_ = false;
    view_name_ = views[number].name;
    camera_.glide_to(view::orbit_of(views[number]));
}

void Viewer::start_film() {
    if (film_.valid() || !options_.make_film) return;
    film_file_ = options_.session.parent_path() / (options_.session.stem().string() + ".mp4");
    film_ = std::async(std::launch::async, options_.make_film, film_file_, view_name_);
}

void Viewer::handle_key(platform::Key key) {
    using platform::Key;
    switch (key) {
        case Key::space:
            return toggle_playing();
        case Key::left:
            return seek(time_ - key_step);
        case Key::right:
            return seek(time_ + key_step);
        case Key::up:
            return change_speed(1);
        case Key::down:
            return change_speed(-1);
        case Key::page_up:
            return seek(recording_->neighbouring_chapter(time_, -1));
        case Key::page_down:
            return seek(recording_->neighbouring_chapter(time_, 1));
        case Key::home:
            return seek(0.0);
        case Key::end:
            return seek(recording_->duration());
        case Key::f:
            follows_ = true;
            followed_joint_.reset();
            view_name_.clear();
            return;
        case Key::p:
            picture_ = SavedPicture::requested;
            return;
        case Key::v:
            return start_film();
        case Key::f11:
            full_screen_requested_ = true;
            return;
        case Key::escape:
            closed_ = true;
            return;
        default:
            if (key >= Key::digit_1 && key <= Key::digit_9)
                show_view(static_cast<std::size_t>(key) - static_cast<std::size_t>(Key::digit_1));
    }
}

void Viewer::handle_events(std::span<const platform::InputEvent> events, VkExtent2D size) {
    for (const platform::InputEvent& event : events) {
        closed_ = closed_ || std::holds_alternative<platform::CloseEvent>(event);
        if (const auto* key = std::get_if<platform::KeyEvent>(&event); key != nullptr && key->down)
            handle_key(key->key);
    }
    if (gpu_->ui->wants_pointer()) return mouse_.stop();
    const double height = size.height, aspect = size.width / height;
    if (mouse_.apply(events, {height, aspect}, camera_.goal, gpu_->replay->workplace.workpiece)) {
        follows_ = false;
        view_name_.clear();
    }
}

void Viewer::advance(double seconds) {
    const double before = time_;
    if (playing_) seek(time_ + speed_ * std::min(seconds, longest_frame));
    if (time_ >= recording_->duration()) playing_ = false;
    played_ = std::max(time_ - before, 0.0);
}

const world::Joint* Viewer::joint_at_work() const {
    const RecordedState& state = recording_->states[recording_->index_at(time_)];
    const std::int16_t held = state.contact.joint;
    const TimelineMark* chapter = recording_->chapter_at(time_);
    const int joint = held >= 0 ? held : chapter != nullptr ? chapter->joint : 0;
    if (joint < 0) return nullptr;
    return &state.joints[static_cast<std::size_t>(joint)];
}

// Turns the camera to the joint at work when it changes.
void Viewer::follow_work(double aspect) {
    if (!follows_) return;
    const world::Joint* joint = joint_at_work();
    if (joint == nullptr || followed_joint_ == joint->index) return;
    followed_joint_ = joint->index;
    const session::SessionSetup& start = recording_->start;
    view::ViewTarget target{
        start.setup, start.state.tool_contact ? &*start.state.tool_contact : nullptr, joint->index,
        world::nut_centre(gpu_->replay->workplace.world, start.setup, joint->index), std::nullopt};
    target.aspect = aspect;
    camera_.glide_to(view::find_view(target, visibility_, camera_.goal));
}

// Writes the picture that the previous frame rendered.
Status Viewer::save_picture() {
    picture_ = SavedPicture::none;
    view::GpuContext& gpu = *gpu_->context;
    BOLT_TRY(gpu.device->idle());
    const render::ImageLayer made = gpu.renderer->picture(0, saved_group);
    BOLT_TRY_ASSIGN(
        const auto texels,
        gpu::download_image(*gpu.device, *made.image, gpu::ResourceUse::transfer_from, 4, 0, made.layer));
    render::Picture picture{saved_size.width, saved_size.height, {}};
    picture.rgba.reserve(texels.size());
    for (const std::byte b : texels) picture.rgba.push_back(static_cast<std::uint8_t>(b));
    const auto file = options_.session.parent_path() /
                      fmt::format("{}-{:.1f}s.png", options_.session.stem().string(), time_);
    const Status written = view::write_picture(picture, file);
    message_ = written ? words::format_text(options_.words, "viewer.saved", {{"file", file.string()}})
                       : written.error().message();
    return {};
}

void Viewer::finish_film() {
    using namespace std::chrono_literals;
    if (!film_.valid() || film_.wait_for(0s) != std::future_status::ready) return;
    const Status made = film_.get();
    message_ = made ? words::format_text(options_.words, "viewer.saved", {{"file", film_file_.string()}})
                    : made.error().message();
}

Status Viewer::update(const view::WindowFrame& window) {
    const VkExtent2D size = window.size;
    if (picture_ == SavedPicture::drawn) BOLT_TRY(save_picture());
    finish_film();
    trainer::update_ui_input(input_, window.events);
    input_.keys = {};  // all keys are the viewer's: the interface would press its focused button as well
    input_.size = glm::vec2(size.width, size.height);
    input_.scale = window.scale;
    input_.seconds = window.seconds;
    handle_events(window.events, size);
    advance(window.seconds);

    film::ReplayScene& replay = *gpu_->replay;
    const std::size_t index = recording_->index_at(time_);
    write_state(replay.workplace.world, recording_->states[index]);
    const session::SessionSetup& start = recording_->start;
    const film::ReplayMoment moment{start.setup, recording_->lessons[recording_->lesson_index[index]],
                                    start.state.tool_contact ? &*start.state.tool_contact : nullptr,
                                    options_.words, played_};
    film::update_poses(replay, moment);
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    follow_work(static_cast<double>(aspect));
    (void)camera_.advance(window.seconds);
    film::collect_frame(replay, moment, Vec3(view::viewpoint_of(camera_.shown).eye));
    return {};
}

Status Viewer::draw(gpu::FrameContext& frame, const view::WindowFrame& window) {
    const VkExtent2D size = window.size;
    const float scale = window.scale,
                aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    film::ReplayScene& replay = *gpu_->replay;
    render::Renderer& renderer = *gpu_->context->renderer;
    const render::BoundingBox box = render::bounds(replay.scene);
    const render::Eye eye = view::eye_of(camera_.shown, box, aspect);
    BOLT_TRY(renderer.render(frame, replay.scene, std::span(&eye, 1), size));
    if (picture_ == SavedPicture::requested) {
        const render::Eye wide = view::eye_of(
            camera_.shown, box, static_cast<float>(saved_size.width) / static_cast<float>(saved_size.height));
        BOLT_TRY(renderer.render(frame, replay.scene, std::span(&wide, 1), saved_size, saved_group));
        picture_ = SavedPicture::drawn;
    }
    BOLT_TRY(gpu_->ui->begin(frame, input_));
    draw_bar(input_.size, scale);
    draw_panel(input_.size, scale);
    draw_message(scale);
    const render::Overlay overlay = gpu_->ui->end();
    return renderer.draw_over(frame, overlay, renderer.picture(0));
}

}  // namespace bolt::viewer
