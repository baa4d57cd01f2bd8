// The trainer without a window, with somebody at it: events go in, pictures come out.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>

#include "game/trainer/app.hpp"

namespace bolt::test {

namespace fs = std::filesystem;
using namespace bolt::trainer;  // what it is all about

inline constexpr VkExtent2D size{320, 180};
inline constexpr double step = 0.1;  // s a frame

// A program with somebody at it.
class Desk {
  public:
    explicit Desk(AppOptions options) {
        folder_ = fs::path(BOLT_TRAINER_OUT) / options.choice.assembly;
        fs::create_directories(folder_);
        options.out = folder_;
        options.tell = [this](const std::string& line) { told_.push_back(line); };
        options.ended = [this](const content::Assembly&, const play::CourseOptions&,
                               const play::Played& played) {
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
    void make_gpu() {
        auto painter = view::make_painter(*instance_, {}, {});
        if (!painter) FAIL(painter.error().message());
        painter_ = std::move(*painter);
        need(app_->start(painter_));
    }
    // As the window does when a GPU is lost.
    void another_gpu() {
        app_->drop();
        (void)painter_.device->idle();
        painter_.renderer.reset();
        painter_.frames.reset();
        painter_.device.reset();
        make_gpu();
    }
    ~Desk() {
        app_->drop();
        (void)painter_.device->idle();
        for (const std::string& message : instance_->log().messages) FAIL_CHECK(message);
    }
    Desk(const Desk&) = delete;
    Desk& operator=(const Desk&) = delete;

    void need(const Status& status) {
        if (!status) FAIL(status.error().message());
    }
    void frame(std::vector<platform::Event> events = {}) { need(try_frame(std::move(events))); }
    Status try_frame(std::vector<platform::Event> events = {}) {
        auto frame = painter_.frames->begin();
        if (!frame) FAIL(frame.error().message());
        // Small letters: all of a panel fits.
        const Status drawn = app_->frame(**frame, events, size, 0.3F, step);
        need(painter_.frames->submit(**frame));
        return drawn;
    }
    void move(const glm::dvec2& to) { frame({platform::CursorEvent{to}}); }
    void press(const glm::dvec2& at) {
        move(at);
        frame({platform::ButtonEvent{platform::Button::left, true, at}});
    }
    void release(const glm::dvec2& at) { frame({platform::ButtonEvent{platform::Button::left, false, at}}); }
    void key(platform::Key key) {
        frame({platform::KeyEvent{key, true, false, {}}});
        frame({platform::KeyEvent{key, false, false, {}}});
    }
    // False: there is no such button. New panels have found their size after two frames.
    bool push(words::Key label) {
        frame();
        frame();
        for (const ButtonPlace& button : app_->buttons()) {
            if (button.label != label) continue;
            const glm::dvec2 at(button.middle);
            press(at);
            release(at);
            frame();
            return true;
        }
        return false;
    }
    App& app() { return *app_; }
    [[nodiscard]] const Playing& playing() const { return *app_->playing(); }
    [[nodiscard]] Screen screen() const { return screen_of(playing(), glm::dvec2(size.width, size.height)); }
    [[nodiscard]] const std::vector<std::string>& told() const { return told_; }
    [[nodiscard]] const std::optional<play::Played>& played() const { return played_; }
    [[nodiscard]] const fs::path& folder() const { return folder_; }

  private:
    std::optional<gpu::Instance> instance_;
    fs::path folder_;
    view::Painter painter_;
    std::unique_ptr<App> app_;
    std::vector<std::string> told_;
    std::optional<play::Played> played_;
};

inline AppOptions options(const char* assembly, bool menu) {
    AppOptions o;
    o.choice.assembly = assembly;
    o.menu = menu;
    o.course.obstacles = play::Obstacles::if_any;
    return o;
}

}  // namespace bolt::test
