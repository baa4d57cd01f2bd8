#include "game/viewer/viewer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>

#include "engine/gpu/resources.hpp"
#include "game/lesson/feedback.hpp"
#include "game/trainer/controls.hpp"

namespace bolt::viewer {

namespace {

constexpr float text_size = 14.0F;        // points
constexpr float panel_width = 300.0F;     // points
constexpr double key_step = 2.0;          // s
constexpr double longest_frame = 0.25;    // s
constexpr std::uint32_t saved_group = 3;  // of the renderer's pictures: the picture to save
constexpr VkExtent2D saved_size{1920, 1080};
constexpr double speeds[] = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
constexpr ImU32 line_color = IM_COL32(70, 80, 90, 255), played_color = IM_COL32(70, 150, 210, 255),
                chapter_color = IM_COL32(190, 200, 210, 255), mistake_color = IM_COL32(255, 110, 90, 255),
                curve_color = IM_COL32(115, 205, 255, 255), now_color = IM_COL32(255, 200, 60, 255);
constexpr ImGuiWindowFlags panel_flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                         ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                         ImGuiWindowFlags_NoTitleBar;

void draw_text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

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
    const std::vector<view::Viewpoint>& views = viewer->models_.machine.views;
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
    const auto at = std::find(std::begin(speeds), std::end(speeds), speed_);
    const auto number = std::clamp<std::ptrdiff_t>(at - std::begin(speeds) + by, 0, std::ssize(speeds) - 1);
    speed_ = speeds[number];
}

void Viewer::show_view(std::size_t number) {
    const std::vector<view::Viewpoint>& views = models_.machine.views;
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
    if (mouse_.apply(events, {height, aspect}, camera_.goal, gpu_->replay->workplace.machine)) {
        follows_ = false;
        view_name_.clear();
    }
}

void Viewer::advance(double seconds) {
    const double before = time_;
    if (playing_) seek(time_ + speed_ * std::min(seconds, longest_frame));
    if (time_ >= recording_->duration()) playing_ = false;
    moved_ = std::max(time_ - before, 0.0);
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

// "F1: Tighten to 72 N·m", as the lesson shows it.
std::string Viewer::step_text(const TimelineMark& chapter) const {
    if (chapter.joint < 0) return chapter.event.text;
    const std::string& id =
        recording_->start.assembly.joints[static_cast<std::size_t>(chapter.joint)].design.id;
    using lesson::StepKind;
    for (const StepKind kind : {StepKind::run_down, StepKind::tighten, StepKind::recheck, StepKind::loosen}) {
        if (lesson::name(kind) != chapter.event.text) continue;
        const std::string& what = options_.words[lesson::text_key(kind)];
        if (kind != StepKind::tighten)
            return words::format_text(options_.words, "hud.due", {{"joint", id}, {"what", what}});
        return words::format_text(
            options_.words, "hud.due_torque",
            {{"joint", id}, {"what", what}, {"torque", words::torque_number(chapter.event.value)}});
    }
    return id + ": " + chapter.event.text;
}

void Viewer::draw_time_line(float scale) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, 22.0F * scale);
    ImGui::InvisibleButton("##time", size);
    const ImVec2 high(low.x + size.x, low.y + size.y);
    time_line_ = {glm::vec2(low.x, low.y), glm::vec2(high.x, high.y)};
    const double duration = std::max(recording_->duration(), 1e-9);
    const auto x_of = [&](double time) { return low.x + static_cast<float>(time / duration) * size.x; };
    const float pointer = ImGui::GetIO().MousePos.x;
    if (ImGui::IsItemActive()) seek(duration * static_cast<double>((pointer - low.x) / size.x));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float middle = 0.5F * (low.y + high.y), half = 3.0F * scale;
    draw.AddRectFilled({low.x, middle - half}, {high.x, middle + half}, line_color, half);
    draw.AddRectFilled({low.x, middle - half}, {x_of(time_), middle + half}, played_color, half);
    const TimelineMark* nearest = nullptr;
    for (const TimelineMark& mark : recording_->marks) {
        const float x = x_of(mark.time);
        if (mark.mistake)
            draw.AddTriangleFilled({x - 5.0F * scale, low.y}, {x + 5.0F * scale, low.y},
                                   {x, low.y + 8.0F * scale}, mistake_color);
        else
            draw.AddLine({x, middle - 2.0F * half}, {x, middle + 2.0F * half}, chapter_color, scale);
        if (std::abs(x - pointer) < 6.0F * scale && (nearest == nullptr || mark.mistake)) nearest = &mark;
    }
    draw.AddCircleFilled({x_of(time_), middle}, 7.0F * scale, now_color);
    if (ImGui::IsItemHovered() && nearest != nullptr) {
        const std::string text = nearest->explanation
                                     ? lesson::mistake_text(options_.words, *nearest->explanation)
                                 : nearest->mistake ? nearest->event.text
                                                    : step_text(*nearest);
        ImGui::SetTooltip("%.1f s  %s", nearest->time, text.c_str());
    }
}

void Viewer::draw_bar(const glm::vec2& size, float scale) {
    const words::Words& words = options_.words;
    const float height = 82.0F * scale;
    ImGui::SetNextWindowPos({0.0F, size.y - height});
    ImGui::SetNextWindowSize({size.x, height});
    ImGui::SetNextWindowBgAlpha(0.9F);
    ImGui::Begin("##bar", nullptr, panel_flags);
    if (ImGui::Button("|<")) handle_key(platform::Key::page_up);
    ImGui::SameLine();
    if (ImGui::Button((playing_ ? words["viewer.pause"] : words["viewer.play"]).c_str(),
                      {90.0F * scale, 0.0F}))
        toggle_playing();
    ImGui::SameLine();
    if (ImGui::Button(">|")) handle_key(platform::Key::page_down);
    ImGui::SameLine();
    draw_text(fmt::format("{:6.1f} / {:.1f} s", time_, recording_->duration()));
    for (const double speed : speeds) {
        ImGui::SameLine();
        if (ImGui::RadioButton(fmt::format("{:g}×", speed).c_str(), speed_ == speed)) speed_ = speed;
    }
    if (const auto* chapter = recording_->chapter_at(time_); chapter != nullptr && chapter->joint >= 0) {
        ImGui::SameLine(0.0F, 24.0F * scale);
        draw_text(step_text(*chapter));
    }
    draw_time_line(scale);
    ImGui::End();
}

// Torque over the angle of the nut, as recorded, with the present moment.
void Viewer::draw_curve(float scale) {
    const world::Joint* now = joint_at_work();
    if (now == nullptr) return;
    const analysis::JointCurve& curve = recording_->data.curves[now->index];
    draw_text(fmt::format("{}   {:.1f} N·m   {:.0f}°   {:.1f} kN",
                          recording_->start.assembly.joints[now->index].design.id, now->torque,
                          to_degrees(now->angle), now->clamp / 1e3));
    const ImVec2 low = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, 130.0F * scale);
    ImGui::Dummy(size);
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(low, {low.x + size.x, low.y + size.y}, IM_COL32(18, 22, 26, 255), 4.0F * scale);
    double begin = 1e300, end = -1e300, most = 1.0;
    for (const analysis::Visit& visit : curve.visits)
        for (const analysis::CurvePoint& point : visit.points) {
            if (point.stage == joint::Stage::navigation) continue;
            begin = std::min(begin, point.angle);
            end = std::max(end, point.angle);
            most = std::max(most, std::abs(point.torque));
        }
    if (!(end > begin)) return;
    const auto at = [&](double angle, double torque) {
        const double x = std::clamp((angle - begin) / (end - begin), 0.0, 1.0),
                     y = std::abs(torque) / (1.08 * most);
        return ImVec2(low.x + static_cast<float>(x) * size.x,
                      low.y + size.y * (1.0F - static_cast<float>(std::min(y, 1.0))));
    };
    for (const analysis::Visit& visit : curve.visits)
        for (std::size_t i = 1; i < visit.points.size(); ++i) {
            const analysis::CurvePoint &a = visit.points[i - 1], &b = visit.points[i];
            if (a.stroke != b.stroke || a.stage == joint::Stage::navigation || b.time > time_) continue;
            draw.AddLine(at(a.angle, a.torque), at(b.angle, b.torque), curve_color, 1.4F * scale);
        }
    draw.AddCircleFilled(at(now->angle, now->torque), 4.0F * scale, now_color);
    draw.AddText({low.x + 4.0F * scale, low.y + 2.0F * scale}, chapter_color,
                 fmt::format("{:.0f} N·m", 1.08 * most).c_str());
}

// A bar for the clamp force of each joint; the line is its target.
void Viewer::draw_clamps(float scale) {
    const RecordedState& state = recording_->states[recording_->index_at(time_)];
    const content::Assembly& assembly = recording_->start.assembly;
    double most = 1.0;
    std::vector<double> targets;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        targets.push_back(analysis::target_clamp(assembly, i));
        most = std::max({most, 1.25 * targets.back(), state.joints[i].clamp});
    }
    const world::Joint* at_work = joint_at_work();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        const double clamp = state.joints[i].clamp;
        draw_text(assembly.joints[i].design.id);
        ImGui::SameLine(44.0F * scale);
        const ImVec2 low = ImGui::GetCursorScreenPos();
        const float width = ImGui::GetContentRegionAvail().x - 60.0F * scale,
                    height = ImGui::GetTextLineHeight();
        const auto x_of = [&](double force) { return low.x + static_cast<float>(force / most) * width; };
        draw.AddRectFilled(low, {low.x + width, low.y + height}, line_color, 2.0F * scale);
        draw.AddRectFilled(low, {x_of(clamp), low.y + height},
                           at_work != nullptr && at_work->index == i ? now_color : played_color,
                           2.0F * scale);
        draw.AddLine({x_of(targets[i]), low.y}, {x_of(targets[i]), low.y + height}, chapter_color,
                     1.5F * scale);
        ImGui::Dummy({width + 4.0F * scale, height});
        ImGui::SameLine();
        draw_text(fmt::format("{:.1f} kN", clamp / 1e3));
    }
}

void Viewer::draw_saving() {
    const words::Words& words = options_.words;
    if (ImGui::Button(words["viewer.picture"].c_str(), {-1.0F, 0.0F})) picture_ = SavedPicture::requested;
    if (film_.valid()) {
        draw_text(words["viewer.making"]);
    } else if (ImGui::Button(words["viewer.film"].c_str(), {-1.0F, 0.0F})) {
        start_film();
    }
}

// In the upper left corner, because a large assembly fills the panel.
void Viewer::draw_message(float scale) {
    if (message_.empty()) return;
    ImGui::SetNextWindowPos({12.0F * scale, 12.0F * scale});
    ImGui::SetNextWindowBgAlpha(0.82F);
    ImGui::Begin("##message", nullptr,
                 panel_flags | ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoInputs);
    draw_text(message_);
    ImGui::End();
}

void Viewer::draw_panel(const glm::vec2& size, float scale) {
    const words::Words& words = options_.words;
    const float width = panel_width * scale;
    ImGui::SetNextWindowPos({size.x - width, 0.0F});
    ImGui::SetNextWindowSize({width, size.y - 82.0F * scale});
    ImGui::SetNextWindowBgAlpha(0.82F);
    ImGui::Begin("##panel", nullptr, panel_flags);
    if (ImGui::RadioButton(words["viewer.follow"].c_str(), follows_)) handle_key(platform::Key::f);
    for (std::size_t i = 0; i < models_.machine.views.size(); ++i) {
        const std::string& name = models_.machine.views[i].name;
        if (i % 3 != 0) ImGui::SameLine();
        if (ImGui::RadioButton(name.c_str(), view_name_ == name)) show_view(i);
    }
    ImGui::Separator();
    draw_curve(scale);
    ImGui::Separator();
    draw_text(words["viewer.clamps"]);
    draw_clamps(scale);
    ImGui::Separator();
    draw_saving();
    if (recording_->mismatches > 0) ImGui::TextWrapped("%s", words["viewer.differs"].c_str());
    ImGui::End();
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
    const film::ReplayMoment moment{start.setup, recording_->lessons[recording_->lesson_of[index]],
                                    start.state.tool_contact ? &*start.state.tool_contact : nullptr,
                                    options_.words, moved_};
    film::place(replay, moment);
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    follow_work(static_cast<double>(aspect));
    (void)camera_.advance(window.seconds);
    film::present(replay, moment, Vec3(view::viewpoint_of(camera_.shown).eye));
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
