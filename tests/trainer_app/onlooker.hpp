// Somebody who presses keys and nuts in the trainer and looks at what is shown.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>

#include "engine/gpu/transfer.hpp"
#include "engine/render/picture.hpp"
#include "game/trainer/app.hpp"
#include "game/trainer/pointing.hpp"

namespace bolt::test {

class Onlooker {
  public:
    // `folder`: of its own, below the tests' output.
    Onlooker(trainer::AppOptions options, const char* folder, VkExtent2D size, float scale,
             bool validated_too = true)
        : size_(size), scale_(scale) {
        options.out = std::filesystem::path(BOLT_TRAINER_OUT) / folder;
        std::filesystem::create_directories(options.out);
        gpu::InstanceOptions validated;
        validated.validation = validated_too;
        auto instance = gpu::Instance::create(validated);
        if (!instance) FAIL(instance.error().message());
        instance_.emplace(std::move(*instance));
        render::RendererOptions drawn;
        drawn.level_error_px = 0.7F;
        auto painter = view::make_painter(*instance_, {}, drawn);
        if (!painter) FAIL(painter.error().message());
        painter_ = std::move(*painter);
        app_.emplace(std::move(options));
        need(app_->start(painter_));
    }
    ~Onlooker() {
        app_->drop();
        (void)painter_.device->idle();
        for (const std::string& message : instance_->log().messages) FAIL_CHECK(message);
    }
    Onlooker(const Onlooker&) = delete;
    Onlooker& operator=(const Onlooker&) = delete;

    void frame(std::vector<platform::Event> events = {}, double seconds = 0.1) {
        auto frame = painter_.frames->begin();
        if (!frame) FAIL(frame.error().message());
        need(app_->frame(**frame, events, size_, scale_, seconds));
        need(painter_.frames->submit(**frame));
    }
    void wait(double seconds) {
        for (double t = 0.0; t < seconds; t += 0.1) frame();
    }
    void key(platform::Key key) { frame({platform::KeyEvent{key, true, false, {}}}); }
    void move(const glm::dvec2& to) { frame({platform::CursorEvent{to}}); }
    void button(bool down, const glm::dvec2& at) {
        frame({platform::CursorEvent{at}, platform::ButtonEvent{platform::Button::left, down, at}});
    }
    // On the nut, held: until the hand has arrived and is on it.
    glm::dvec2 hold(std::size_t joint) {
        using trainer::Doing;
        const auto at = nut(joint);
        move(at);
        REQUIRE(playing().under == joint);
        button(true, at);
        for (int i = 0; i < 60 && playing().course->state().engagement.joint != static_cast<int>(joint); ++i)
            frame();
        REQUIRE(playing().course->state().engagement.joint == static_cast<int>(joint));
        return at;
    }
    // px, of the nut's middle.
    glm::dvec2 nut(std::size_t joint) {
        const play::Course& course = *playing().course;
        const auto at = project(
            screen(), servo::nut_centre(course.setup().nuts[joint], course.state().joints[joint].nut.angle));
        REQUIRE(at);
        return *at;
    }
    render::Picture picture() {
        need(painter_.frames->finish());
        const render::Layer made = painter_.renderer->picture(0);
        const auto texels =
            gpu::download_image(*painter_.device, *made.image, gpu::Use::transfer_from, 4, 0, made.layer);
        if (!texels) FAIL(texels.error().message());
        render::Picture picture{size_.width, size_.height, {}};
        for (const std::byte b : *texels) picture.rgba.push_back(static_cast<std::uint8_t>(b));
        return picture;
    }
    [[nodiscard]] trainer::Screen screen() const {
        return trainer::screen_of(playing(), glm::dvec2(size_.width, size_.height));
    }
    [[nodiscard]] const trainer::Playing& playing() const { return *app_->playing(); }
    trainer::App& app() { return *app_; }

    void need(const Status& status) {
        if (!status) FAIL(status.error().message());
    }

  private:
    std::optional<gpu::Instance> instance_;
    view::Painter painter_;
    std::optional<trainer::App> app_;
    VkExtent2D size_;
    float scale_;
};

}  // namespace bolt::test
