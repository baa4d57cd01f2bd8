// Plays a trainer in a headset: the trainee's poses go to a runtime that can be told them (the mock, Monado's
// remote driver), and come back through OpenXR, with the frames of view::run_in_window.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>

#include "game/trainer/app.hpp"
#include "tests/room/trainee_in_room.hpp"
#include "tests/support/turns.hpp"
#include "tests/trainer_window/program.hpp"

namespace bolt::test {

struct HeadsetDriverOptions {
    // s of the lesson per frame of the headset, whatever the clock says: a lesson takes as many frames on
    // every computer.
    double step = 0.02;
    // s of the lesson between frames that are drawn; 0: every frame is. The frames between them show the last
    // picture again, which saves most of the time on a computer without a GPU.
    double draw_interval = 0.0;
    // Folder for the drawn pictures, both eyes side by side, 00000.png and so on; empty: none.
    std::filesystem::path pictures;
    // Each frame is repeated with the same poses until this is true, for devices that run in real time;
    // empty: no frame is repeated.
    std::function<bool()> settled;
};

// The frames in which the user saw the lesson.
struct HeadsetFrames {
    int count = 0;
    double seconds = 0.0;         // of the clock
    double grip_error = 0.0;      // m, the largest distance of a hand from where it was last sent
    int without_hand = 0;         // frames in which the runtime had no pose for an active hand
    bool unlike_trigger = false;  // a value of the trigger or squeeze was not the one last sent
};

// Tells the runtime where head and hands are, poses in the room's frame.
using SendPoses = std::function<Status(const Pose& head, const xr::Hands& hands)>;

class HeadsetDriver final : public view::WindowContent, public RoomDriver {
  public:
    HeadsetDriver(trainer::App& app, SendPoses send, HeadsetDriverOptions options)
        : app_(app), send_(std::move(send)), options_(std::move(options)) {}

    // As the content of the window: the app, whose user acts after each frame that was drawn in the headset.
    Status start(view::GpuContext& gpu_context) override;
    void release() override;
    Status update(const view::WindowFrame& window) override;
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override;
    Status frame_while_hidden() override { return app_.frame_while_hidden(); }
    Status end() override { return app_.end(); }
    [[nodiscard]] bool wants_passthrough() const override { return app_.wants_passthrough(); }
    [[nodiscard]] bool closed() const override { return user_done_ || app_.closed(); }

    // As the driver of a trainee, in the trainee's thread.
    void frame(const Pose& head, const xr::Hands& hands) override;
    [[nodiscard]] const trainer::App& app() const override { return app_; }
    [[nodiscard]] double step() const override { return options_.step; }

    void set_draw_interval(double interval) { options_.draw_interval = interval; }

    [[nodiscard]] Turns& turns() { return turns_; }
    [[nodiscard]] const HeadsetFrames& frames() const { return frames_; }
    // The hands that the last frame got from the runtime.
    [[nodiscard]] const xr::Hands& received() const { return received_; }

  private:
    void compare(const view::ImmersiveFrame& immersive);
    Status take_picture();

    trainer::App& app_;
    SendPoses send_;
    HeadsetDriverOptions options_;
    Turns turns_;
    bool user_done_ = false;
    view::GpuContext* gpu_ = nullptr;
    HeadsetFrames frames_;
    xr::Hands sent_, received_;
    std::optional<std::chrono::steady_clock::time_point> last_frame_;
    std::optional<VkExtent2D> drawn_;  // size of the pictures since start(); none: nothing was drawn
    bool newly_drawn_ = false;         // in the last frame
    double drawn_at_ = 0.0;            // s of the lesson
    int pictures_ = 0;
};

// Plays in the headset until `act` is done. The lesson's outcome and log stay in `program`; `log` gets the
// headset's lines.
Status play_in_headset(Program& program, HeadsetDriver& driver, std::vector<std::string>& log,
                       const std::function<void()>& act);

// Plays a guided lesson with a driven hand, and checks that it is finished, good and recorded. `before` is
// called when the lesson has begun; it may be empty.
void play_lesson_in_headset(Program& program, HeadsetDriver& driver,
                            const std::function<void(const Pose& head)>& before = {});

// The options of such a lesson. `out`: the folder for its session.
trainer::AppOptions headset_lesson_options(const std::string& assembly, const std::filesystem::path& out);

}  // namespace bolt::test
