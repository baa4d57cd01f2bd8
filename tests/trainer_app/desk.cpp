#include "tests/trainer_app/desk.hpp"

#include "engine/gpu/resources.hpp"

namespace bolt::test {

using namespace trainer;  // what it is all about

namespace {

void need(const Status& status) {
    if (!status) FAIL(status.error().message());
}

}  // namespace

Desk::Desk(AppOptions options, Display display) : folder_(options.out), display_(display) {
    if (folder_.empty()) folder_ = std::filesystem::path(BOLT_TRAINER_OUT) / options.choice.assembly;
    std::filesystem::create_directories(folder_);
    options.out = folder_;
    options.tell = [this](const std::string& line) { told_.push_back(line); };
    options.ended = [this](const content::Assembly&, const session::CourseOptions&,
                           const session::Played& played) {
        played_ = played;
        return Status{};
    };
    gpu::InstanceOptions validated;
    validated.validation = true;
    auto instance = gpu::Instance::create(validated);
    if (!instance) FAIL(instance.error().message());
    instance_.emplace(std::move(*instance));
    app_ = std::make_unique<App>(std::move(options));
    make_gpu();
}

void Desk::make_gpu() {
    render::RendererOptions drawn;
    drawn.level_error_px = 0.7F;  // as the window
    auto painter = view::make_painter(*instance_, {}, drawn);
    if (!painter) FAIL(painter.error().message());
    painter_ = std::move(*painter);
    need(app_->start(painter_));
}

void Desk::another_gpu() {
    app_->drop();
    (void)painter_.device->idle();
    painter_.renderer.reset();
    painter_.frames.reset();
    painter_.device.reset();
    make_gpu();
}

Desk::~Desk() {
    app_->drop();
    (void)painter_.device->idle();
    for (const std::string& message : instance_->log().messages) FAIL_CHECK(message);
}

Status Desk::draw(const std::vector<platform::Event>& events, double seconds) {
    auto frame = painter_.frames->begin();
    if (!frame) FAIL(frame.error().message());
    Status drawn = app_->frame(**frame, events, display_.size, display_.scale, seconds);
    need(painter_.frames->submit(**frame));
    return drawn;
}

void Desk::frame(const std::vector<platform::Event>& events, double seconds) { need(draw(events, seconds)); }
Status Desk::try_frame() { return draw({}, display_.step); }

void Desk::wait(double seconds) {
    for (double t = 0.0; t < seconds; t += display_.step) frame();
}

void Desk::key(platform::Key key) {
    frame({platform::KeyEvent{key, true, false, {}}});
    frame({platform::KeyEvent{key, false, false, {}}});
}

void Desk::move(const glm::dvec2& to) { frame({platform::CursorEvent{to}}); }

void Desk::press(const glm::dvec2& at) {
    move(at);
    frame({platform::ButtonEvent{platform::Button::left, true, at}});
}

void Desk::release(const glm::dvec2& at) {
    frame({platform::ButtonEvent{platform::Button::left, false, at}});
}

glm::dvec2 Desk::hold(std::size_t joint) {
    const auto on = [&] { return playing().course->state().engagement.joint == static_cast<int>(joint); };
    const session::Course& course = *playing().course;
    const auto at = project(
        screen(), servo::nut_centre(course.setup().nuts[joint], course.state().joints[joint].nut.angle));
    REQUIRE(at);
    move(*at);
    REQUIRE(playing().pointing.nut == joint);
    press(*at);
    for (int i = 0; i < 60 && !on(); ++i) frame();
    REQUIRE(on());
    return *at;
}

render::Picture Desk::picture() {
    need(painter_.frames->finish());
    const render::ImageLayer made = painter_.renderer->picture(0);
    const auto texels =
        gpu::download_image(*painter_.device, *made.image, gpu::ResourceUse::transfer_from, 4, 0, made.layer);
    if (!texels) FAIL(texels.error().message());
    render::Picture picture{display_.size.width, display_.size.height, {}};
    for (const std::byte b : *texels) picture.rgba.push_back(static_cast<std::uint8_t>(b));
    return picture;
}

}  // namespace bolt::test
