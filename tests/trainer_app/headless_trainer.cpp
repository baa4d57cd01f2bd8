#include "tests/trainer_app/headless_trainer.hpp"

#include <algorithm>

#include "engine/gpu/resources.hpp"
#include "tests/support/need.hpp"

namespace bolt::test {

using namespace trainer;

// The resolution of lessons in frames whose picture nobody reads, as in view::WindowFrame. Most of the time
// passes in shading their pixels.
constexpr float unseen_resolution = 0.35F;

HeadlessTrainer::HeadlessTrainer(AppOptions options, Display display, std::optional<StudyRun> study)
    : folder_(options.out), display_(display) {
    if (folder_.empty()) folder_ = std::filesystem::path(BOLT_TRAINER_OUT) / options.choice.assembly;
    std::filesystem::create_directories(folder_);
    options.out = folder_;
    options.log = [this](const std::string& line) { log_.push_back(line); };
    options.on_end = [this](const content::Assembly&, const session::LessonOptions&,
                            const session::LessonOutcome& outcome, const std::filesystem::path&) {
        outcome_ = outcome;
        return Status{};
    };
    app_ = std::make_unique<App>(std::move(options), std::move(study));
    need(app_->start(gpu_.context()));
}

void HeadlessTrainer::lose_gpu() {
    app_->release();
    gpu_.lose();
    need(app_->start(gpu_.context()));
}

HeadlessTrainer::~HeadlessTrainer() {
    app_->release();
    (void)gpu_.context().device->idle();
    for (const std::string& message : gpu_.instance().log().messages) FAIL_CHECK(message);
}

// The frame of an input and the next two are drawn, unless the input only moves the pointer or the wheel.
bool HeadlessTrainer::is_due(const std::vector<platform::InputEvent>& events) {
    constexpr int answers = 3;  // frames
    const bool moves_only = std::all_of(events.begin(), events.end(), [](const platform::InputEvent& event) {
        return std::holds_alternative<platform::CursorEvent>(event) ||
               std::holds_alternative<platform::WheelEvent>(event);
    });
    since_input_ = moves_only ? since_input_ + 1 : 0;
    const bool runs = app_->screen() == trainer::ShownScreen::lesson && !app_->lesson()->clock.paused;
    return !runs || since_input_ < answers || since_input_ % draw_interval == 0;
}

Status HeadlessTrainer::run_frame(const std::vector<platform::InputEvent>& events, double seconds) {
    view::WindowFrame window{
        events, display_.size, display_.scale, seconds, immersive ? &*immersive : nullptr, resolution};
    BOLT_TRY(app_->update(window));
    if (app_->screen() == trainer::ShownScreen::lesson && !immersive)
        window.resolution = std::min(resolution, unseen_resolution);
    const bool is_drawn = draws && is_due(events);
    drawn_ = is_drawn && window.resolution == resolution;
    return is_drawn ? draw(window) : Status{};
}

Status HeadlessTrainer::draw(const view::WindowFrame& window) {
    const auto frame = gpu_.context().frames->begin();
    if (!frame) FAIL(frame.error().message());
    Status drawn = app_->draw(**frame, window);
    need(gpu_.context().frames->submit(**frame));
    return drawn;
}

void HeadlessTrainer::frame(const std::vector<platform::InputEvent>& events, double seconds) {
    need(run_frame(events, seconds));
}
Status HeadlessTrainer::try_frame() { return run_frame({}, display_.step); }

void HeadlessTrainer::wait(double seconds) {
    for (double t = 0.0; t < seconds; t += display_.step) frame();
}

void HeadlessTrainer::key(platform::Key key) {
    frame({platform::KeyEvent{key, true, false, {}}});
    frame({platform::KeyEvent{key, false, false, {}}});
}

void HeadlessTrainer::move(const glm::dvec2& to) { frame({platform::CursorEvent{to}}); }

void HeadlessTrainer::press(const glm::dvec2& at) {
    move(at);
    frame({platform::ButtonEvent{platform::Button::left, true, at}});
}

void HeadlessTrainer::release(const glm::dvec2& at) {
    frame({platform::ButtonEvent{platform::Button::left, false, at}});
}

void HeadlessTrainer::turn_button(const glm::dvec2& at, bool down) {
    frame({platform::ButtonEvent{platform::Button::right, down, at}});
}

void HeadlessTrainer::drag(const glm::dvec2& to, int notches) {
    std::vector<platform::InputEvent> events{platform::CursorEvent{to}};
    if (notches != 0) events.emplace_back(platform::WheelEvent{{0.0, static_cast<double>(notches)}, to});
    frame(events);
}

glm::dvec2 HeadlessTrainer::hold(std::size_t joint) {
    const auto on = [&] { return lesson().session->state().engagement.joint == static_cast<int>(joint); };
    const session::LessonSession& session = *lesson().session;
    const auto at = project(projection(), servo::nut_centre(session.setup().nuts[joint],
                                                            session.state().joints[joint].nut.angle));
    REQUIRE(at);
    move(*at);
    REQUIRE(lesson().pointer.nut == joint);
    press(*at);
    for (int i = 0; i < 60 && !on(); ++i) frame();
    REQUIRE(on());
    return *at;
}

render::Picture HeadlessTrainer::picture() {
    if (!std::exchange(drawn_, true))
        need(draw({{}, display_.size, display_.scale, 0.0, immersive ? &*immersive : nullptr, resolution}));
    need(gpu_.context().frames->finish());
    const render::Renderer& renderer = *gpu_.context().renderer;
    const render::ImageLayer made = immersive ? renderer.picture(0) : app_->window_picture(renderer);
    const auto texels = gpu::download_image(*gpu_.context().device, *made.image,
                                            gpu::ResourceUse::transfer_from, 4, 0, made.layer);
    if (!texels) FAIL(texels.error().message());
    render::Picture picture{display_.size.width, display_.size.height, {}};
    for (const std::byte b : *texels) picture.rgba.push_back(static_cast<std::uint8_t>(b));
    return picture;
}

render::Picture HeadlessTrainer::room_picture(std::uint32_t view) {
    need(gpu_.context().frames->finish());
    const render::ImageLayer made = gpu_.context().renderer->picture(view, view::immersive_group);
    const VkExtent2D size = immersive->groups.front().size;
    const auto texels = need(gpu::download_image(*gpu_.context().device, *made.image,
                                                 gpu::ResourceUse::transfer_from, 4, 0, made.layer));
    render::Picture picture{size.width, size.height, {}};
    for (const std::byte b : texels) picture.rgba.push_back(static_cast<std::uint8_t>(b));
    return picture;
}

}  // namespace bolt::test
