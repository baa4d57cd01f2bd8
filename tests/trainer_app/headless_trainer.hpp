// The trainer without a window: takes input events, renders pictures.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>

#include "engine/render/renderer.hpp"
#include "game/trainer/app.hpp"
#include "tests/trainer_app/gpu_pool.hpp"
#include "tests/trainer_app/trainer_driver.hpp"

namespace bolt::test {

struct Display {
    VkExtent2D size{160, 90};  // small, because a lesson has a thousand pictures
    float scale = 0.15F;       // small letters, so that panels fit
    double step = 0.1;         // s per frame
};

inline trainer::AppOptions options(const char* assembly, bool menu) {
    trainer::AppOptions o;
    o.choice.assembly = assembly;
    o.menu = menu;
    o.lesson.obstacles = session::ObstacleUse::if_any;
    return o;
}

class HeadlessTrainer : public TrainerDriver {
  public:
    // Writes sessions to `options.out`; empty: to a folder named after the assembly in the tests' output
    // folder.
    explicit HeadlessTrainer(trainer::AppOptions options, Display display = {},
                             std::optional<trainer::StudyRun> study = {});
    ~HeadlessTrainer() override;
    HeadlessTrainer(const HeadlessTrainer&) = delete;
    HeadlessTrainer& operator=(const HeadlessTrainer&) = delete;

    // Creates a new GPU device, as the window does after a loss.
    void lose_gpu();

    void frame() override { frame({}, display_.step); }
    void frame(const std::vector<platform::InputEvent>& events) { frame(events, display_.step); }
    void frame(const std::vector<platform::InputEvent>& events, double seconds);
    Status try_frame();
    void wait(double seconds);

    void key(platform::Key key) override;
    void move(const glm::dvec2& to) override;
    void press(const glm::dvec2& at) override;
    void release(const glm::dvec2& at) override;
    void turn_button(const glm::dvec2& at, bool down) override;
    void drag(const glm::dvec2& to, int notches) override;
    // Presses on a nut and waits until the hand holds it. Returns the position in px.
    glm::dvec2 hold(std::size_t joint);

    // The display that surrounds the user in the next frames; none: the window alone.
    std::optional<view::ImmersiveFrame> immersive;
    float resolution = 1.0F;  // as in view::WindowFrame
    bool draws = true;        // false: the next frames are not drawn, which is faster
    // While a lesson runs without input, one frame in `draw_interval` is drawn, because drawing takes long.
    int draw_interval = 20;
    // A picture of a view of the last immersive frame.
    [[nodiscard]] render::Picture room_picture(std::uint32_t view);

    trainer::App& app() { return *app_; }
    [[nodiscard]] const trainer::App& app() const override { return *app_; }
    [[nodiscard]] double step() const { return display_.step; }  // s per frame
    [[nodiscard]] glm::dvec2 size() const override { return {display_.size.width, display_.size.height}; }
    // The picture of the last frame, which is drawn for it if it was not.
    [[nodiscard]] render::Picture picture();
    [[nodiscard]] const std::vector<std::string>& log() const { return log_; }
    [[nodiscard]] const std::optional<session::LessonOutcome>& outcome() const { return outcome_; }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  private:
    Status run_frame(const std::vector<platform::InputEvent>& events, double seconds);
    Status draw(const view::WindowFrame& window);
    [[nodiscard]] bool is_due(const std::vector<platform::InputEvent>& events);

    std::filesystem::path folder_;
    Display display_;
    BorrowedGpu gpu_;
    std::unique_ptr<trainer::App> app_;
    int since_input_ = 0;  // frames
    bool drawn_ = false;   // the last frame was drawn
    std::vector<std::string> log_;
    std::optional<session::LessonOutcome> outcome_;
};

}  // namespace bolt::test
