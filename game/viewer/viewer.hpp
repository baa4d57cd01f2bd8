// Shows a replayed session in a window: the workplace from any side, a time line with the steps and mistakes
// of the lesson, the torque curve of the joint at work and the clamp forces of all joints.
#pragma once

#include <array>
#include <functional>
#include <future>
#include <optional>

#include "engine/ui/ui.hpp"
#include "game/film/film.hpp"
#include "game/view/window.hpp"
#include "game/viewer/recording.hpp"

namespace bolt::viewer {

// Speeds of playing that the viewer offers, relative to real time.
inline constexpr std::array<double, 6> offered_speeds{0.25, 0.5, 1.0, 2.0, 4.0, 8.0};

struct ViewerOptions {
    std::filesystem::path session;  // pictures and films are saved beside it
    words::Words words;
    hand::Side hand = hand::Side::right;  // the working hand
    double at = 0.0;                      // s, time that is shown first
    // Makes a film of the session from a named view (empty: following the work). Runs on a thread of its own.
    std::function<Status(const std::filesystem::path& file, const std::string& view)> make_film;
};

class Viewer : public view::WindowContent {
  public:
    // Loads the models.
    static Result<std::unique_ptr<Viewer>> create(std::unique_ptr<Recording> recording,
                                                  ViewerOptions options);
    ~Viewer() override;

    Status start(view::GpuContext& gpu_context) override;
    void release() override;
    Status update(const view::WindowFrame& window) override;
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override;
    [[nodiscard]] bool closed() const override { return closed_; }
    [[nodiscard]] bool take_full_screen_request() override {
        return std::exchange(full_screen_requested_, false);
    }

    // The state on the screen, for tests.
    [[nodiscard]] double time() const { return time_; }
    [[nodiscard]] double speed() const { return speed_; }
    [[nodiscard]] bool playing() const { return playing_; }
    [[nodiscard]] const Recording& recording() const { return *recording_; }
    [[nodiscard]] const view::Orbit& camera() const { return camera_.goal; }
    [[nodiscard]] const std::string& message() const { return message_; }
    // The time line in the last frame, px: low and high corner.
    [[nodiscard]] const std::array<glm::vec2, 2>& time_line() const { return time_line_; }

  private:
    struct GpuResources;
    Viewer(std::unique_ptr<Recording> recording, ViewerOptions options, scene::LessonModels models);
    void handle_events(std::span<const platform::InputEvent> events, VkExtent2D size);
    void toggle_playing();
    void handle_key(platform::Key key);
    void show_view(std::size_t number);  // a named view
    void change_speed(int by);           // to the next of the offered speeds
    void start_film();
    [[nodiscard]] std::string step_text(const TimelineMark& chapter) const;
    void seek(double time);
    void advance(double seconds);
    void follow_work(double aspect);
    [[nodiscard]] const world::Joint* joint_at_work() const;
    // viewer_panels.cpp:
    void draw_bar(const glm::vec2& size, float scale);
    void draw_time_line(float scale);
    void draw_panel(const glm::vec2& size, float scale);
    void draw_curve(float scale);
    void draw_clamps(float scale);
    void draw_saving();
    void draw_message(float scale);
    Status save_picture();
    void finish_film();

    std::unique_ptr<Recording> recording_;
    ViewerOptions options_;
    scene::LessonModels models_;

    double time_ = 0.0, speed_ = 1.0, played_ = 0.0;  // s; times real time; s played in this frame
    bool playing_ = true, closed_ = false, full_screen_requested_ = false;
    bool follows_ = true;    // the camera turns to the joint at work
    std::string view_name_;  // the chosen named view
    std::optional<std::size_t> followed_joint_;
    view::CameraGlide camera_;
    view::OrbitControl mouse_;
    motion::VisibilityModel visibility_;

    ui::UiInput input_;
    std::array<glm::vec2, 2> time_line_{};
    std::string message_;  // about what was saved
    enum class SavedPicture : std::uint8_t { none, requested, drawn } picture_ = SavedPicture::none;
    std::future<Status> film_;
    std::filesystem::path film_file_;
    std::unique_ptr<GpuResources> gpu_;
};

}  // namespace bolt::viewer
