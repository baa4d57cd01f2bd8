// The trainer without a window, with somebody at it: events go in, pictures come out.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>

#include "engine/render/renderer.hpp"
#include "game/trainer/app.hpp"
#include "tests/trainer_app/seat.hpp"

namespace bolt::test {

// What stands on the desk.
struct Display {
    VkExtent2D size{160, 90};  // a lesson is a thousand pictures
    float scale = 0.15F;       // small letters: all of a panel fits
    double step = 0.1;         // s a frame
};

inline trainer::AppOptions options(const char* assembly, bool menu) {
    trainer::AppOptions o;
    o.choice.assembly = assembly;
    o.menu = menu;
    o.course.obstacles = session::Obstacles::if_any;
    return o;
}

class Desk : public Seat {
  public:
    // Its sessions are kept in `options.out`; empty: in a folder of the assembly's name below the tests'
    // output.
    explicit Desk(trainer::AppOptions options, Display display = {});
    ~Desk() override;
    Desk(const Desk&) = delete;
    Desk& operator=(const Desk&) = delete;

    // As the window does when a GPU is lost.
    void another_gpu();

    void frame() override { frame({}, display_.step); }
    void frame(const std::vector<platform::Event>& events) { frame(events, display_.step); }
    void frame(const std::vector<platform::Event>& events, double seconds);
    Status try_frame();
    void wait(double seconds);

    void key(platform::Key key) override;
    void move(const glm::dvec2& to) override;
    void press(const glm::dvec2& at) override;
    void release(const glm::dvec2& at) override;
    // On the nut, held: until the hand has arrived and is on it. Where that is.
    glm::dvec2 hold(std::size_t joint);

    trainer::App& app() { return *app_; }
    [[nodiscard]] const trainer::App& app() const override { return *app_; }
    [[nodiscard]] glm::dvec2 size() const override { return {display_.size.width, display_.size.height}; }
    [[nodiscard]] render::Picture picture();
    [[nodiscard]] const std::vector<std::string>& told() const { return told_; }
    [[nodiscard]] const std::optional<session::Played>& played() const { return played_; }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    void make_gpu();
    Status draw(const std::vector<platform::Event>& events, double seconds);

    std::optional<gpu::Instance> instance_;
    std::filesystem::path folder_;
    Display display_;
    view::Painter painter_;
    std::unique_ptr<trainer::App> app_;
    std::vector<std::string> told_;
    std::optional<session::Played> played_;
};

}  // namespace bolt::test
