// A runtime that hangs in the middle of a lesson: the lesson and its window go on.
#include "tests/headset_lesson/headset_driver.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"
#include "tests/support/need.hpp"

using namespace bolt;

namespace {

// Shows a lesson, and hangs the runtime until the window has gone on without the headset.
class HangingLesson final : public view::WindowContent {
  public:
    HangingLesson(trainer::App& app, const test::MockRuntime& mock) : app_(app), mock_(mock) {}

    Status start(view::GpuContext& gpu_context) override { return app_.start(gpu_context); }
    void release() override { app_.release(); }
    Status update(const view::WindowFrame& window) override {
        const view::ImmersiveFrame* immersive = window.immersive;
        const bool is_new = immersive != nullptr && immersive->attentive && !immersive->repeated;
        // The lesson of this frame is that of the last one.
        const bool paused = app_.lesson() != nullptr && app_.lesson()->clock.paused;
        if (!hung_ && is_new && ++seen == 5) {
            hung_ = true;
            mock_->block_wait(true);
        } else if (hung_ && immersive != nullptr && immersive->repeated) {
            ++repeated;
            paused_early = paused_early || paused;
            CHECK(immersive->groups.empty());
        } else if (hung_ && immersive == nullptr && ++alone == 5) {
            paused_alone = paused;
            mock_->block_wait(false);
        } else if (alone >= 5 && is_new && ++returned == 5) {
            paused_at_end = paused;
        }
        return app_.update(window);
    }
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override {
        return app_.draw(frame, window);
    }
    [[nodiscard]] render::ImageLayer window_picture(const render::Renderer& renderer) const override {
        return app_.window_picture(renderer);
    }
    Status end() override { return app_.end(); }
    [[nodiscard]] bool closed() const override { return returned >= 5; }

    // Frames: of the headset, with its last poses while it is late, without it, and of the headset again.
    int seen = 0, repeated = 0, alone = 0, returned = 0;
    bool paused_early = false, paused_alone = false, paused_at_end = true;

  private:
    trainer::App& app_;
    const test::MockRuntime& mock_;
    bool hung_ = false;
};

}  // namespace

TEST_CASE("Headset lesson: a runtime that hangs leaves the lesson in the window, paused, and returns to it") {
    const test::MockRuntime mock;
    test::Program program(test::headset_lesson_options("first-nut", std::string(BOLT_TRAINER_OUT) + "/hang"),
                          platform::Size{160, 120});
    HangingLesson content(*program.app, mock);
    xr::Headset headset(xr::HeadsetOptions{});
    view::WindowRunOptions run;
    run.headset = &headset;
    run.adapts_resolution = false;
    const std::vector<const char*> extensions = test::need(program.desktop.vulkan_extensions());
    run.instance.validation = true;
    run.instance.extensions = extensions;
    const Status done = view::run_in_window(content, program.window, *program.instance, run);
    CHECK_MESSAGE(done.has_value(), (done ? "" : done.error().message()));
    CHECK(content.repeated > 0);
    CHECK_FALSE(content.paused_early);
    CHECK(content.paused_alone);
    CHECK_FALSE(content.paused_at_end);
}
