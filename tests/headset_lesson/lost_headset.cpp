// A headset that is lost during a lesson, or whose session cannot start, in the mock runtime: the lesson goes
// on in the window with the mouse, and the headset gets the hand back.
#include "tests/headset_lesson/headset_driver.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"

using namespace bolt;

namespace {

// The trainer in a window. The test decides in each frame what the user of the window does.
class DeskUser final : public view::WindowContent {
  public:
    using Act = std::function<std::vector<platform::InputEvent>(const view::WindowFrame& window)>;
    DeskUser(trainer::App& app, Act act) : app_(app), act_(std::move(act)) {}

    Status start(view::GpuContext& gpu) override {
        since_drawn_ = draw_interval;
        return app_.start(gpu);
    }
    void release() override { app_.release(); }
    Status update(const view::WindowFrame& window) override {
        view::WindowFrame acted = window;
        acted.seconds = 0.02;
        const std::vector<platform::InputEvent> events = act_(window);
        acted.events = events;
        return app_.update(acted);
    }
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override {
        // Every frame shows a picture, but drawing takes most of the time.
        const bool in_room = window.immersive != nullptr;
        const bool due =
            ++since_drawn_ > draw_interval || draws || std::exchange(was_in_room_, in_room) != in_room;
        if (!due) return {};
        since_drawn_ = 0;
        return app_.draw(frame, window);
    }
    bool move_eyes(const view::WindowFrame& window) override { return app_.move_eyes(window); }
    [[nodiscard]] render::ImageLayer window_picture(const render::Renderer& renderer) const override {
        return app_.window_picture(renderer);
    }
    Status frame_while_hidden() override { return app_.frame_while_hidden(); }
    Status end() override { return app_.end(); }
    [[nodiscard]] bool closed() const override { return done || app_.closed(); }

    bool done = false;
    bool draws = false;  // every frame

  private:
    static constexpr int draw_interval = 8;  // frames
    trainer::App& app_;
    Act act_;
    int since_drawn_ = draw_interval;
    bool was_in_room_ = false;
};

mock::Hand hand_at(const Vec3& position) {
    mock::Hand hand;
    hand.grip.pose.position = hand.aim.pose.position = position;
    return hand;
}

enum class Step : std::uint8_t { wears, notices, resumes, moves, drags, returns };

void play(bool starts) {
    mock::Config config;
    const test::MockRuntime mock(config);
    mock->set_head({{{0.0, 1.65, 0.0}, rotation({-0.4, 0.0, 0.0})}});
    mock->set_hand(mock::Side::right, hand_at({0.2, 1.2, -0.3}));
    if (!starts) mock->fail_next("xrCreateSession", XR_ERROR_RUNTIME_FAILURE, 1);
    trainer::AppOptions options = test::headset_lesson_options("first-nut", BOLT_TRAINER_OUT);
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / (starts ? "lost" : "never");
    test::Program program(std::move(options), platform::Size{320, 240});
    trainer::App& app = *program.app;
    Step step = starts ? Step::wears : Step::notices;
    int frames = 0;  // of the step
    bool called = false;
    Vec3 before(0.0);
    std::vector<std::string> failures;
    const auto check = [&](bool condition, const char* what) {
        if (!condition) failures.emplace_back(what);
    };
    const auto next = [&](Step to) { step = to, frames = 0; };
    DeskUser* shown = nullptr;
    const auto act = [&](const view::WindowFrame& window) -> std::vector<platform::InputEvent> {
        // Else the program tries again after two seconds.
        if (!std::exchange(called, true) && !starts) mock->connect(false);
        const trainer::ActiveLesson* lesson = app.lesson();
        if (lesson == nullptr || !lesson->station) return {};
        const bool seen = window.immersive != nullptr && window.immersive->attentive;
        const trainer::StationClient& client = *lesson->station;
        const Vec3 tool = client.latest.commanded_tool.position;
        const glm::dvec2 middle(0.5 * window.size.width, 0.3 * window.size.height);
        ++frames;
        shown->draws = step == Step::notices;
        switch (step) {
            case Step::wears:
                if (!seen || frames < 10) return {};
                check(client.tracked.has_value(), "the headset tracks the hand");
                mock->send(mock::Event::instance_loss);
                mock->connect(false);
                next(Step::notices);
                return {};
            case Step::notices: {
                if (window.immersive != nullptr || frames < 3) return {};
                check(lesson->clock.paused, "the lesson is paused");
                const auto widgets = app.drawn_widgets();
                check(std::any_of(widgets.begin(), widgets.end(),
                                  [](const auto& widget) {
                                      return widget.label == words::TextKey("room.use_mouse");
                                  }),
                      "the dialog offers the mouse");
                next(Step::resumes);
                return {platform::KeyEvent{platform::Key::escape, true, false, {}},
                        platform::KeyEvent{platform::Key::escape, false, false, {}}};
            }
            case Step::resumes:
                if (frames < 5) return {};
                check(!lesson->clock.paused, "the lesson goes on");
                check(client.dragged.has_value() && !client.tracked, "the mouse has the hand");
                before = tool;
                next(Step::moves);
                return {platform::KeyEvent{platform::Key::d, true, false, {}}};
            case Step::moves:
                if (frames < 25) return {};
                check(glm::distance(tool, before) > 0.02, "a key moves the hand");
                before = tool;
                next(Step::drags);
                return {platform::KeyEvent{platform::Key::d, false, false, {}}, platform::CursorEvent{middle},
                        platform::ButtonEvent{platform::Button::left, true, middle}};
            case Step::drags:
                if (frames < 25) return {platform::CursorEvent{middle + glm::dvec2(4.0 * frames, 0.0)}};
                check(glm::distance(tool, before) > 0.02, "a drag moves the hand");
                mock->connect(true);
                next(Step::returns);
                return {platform::ButtonEvent{platform::Button::left, false, middle}};
            case Step::returns:
                if (!seen) frames = 0;
                if (frames < 60) return {};
                check(client.tracked.has_value() && !client.dragged, "the headset has the hand again");
                check(!lesson->clock.paused, "the lesson goes on in the headset");
                const Pose palm =
                    inverse(trainer::adjusted(*app.room()->workpiece, lesson->workplace.workpiece, 0, 0.0)) *
                    Pose{{0.2, 1.2, -0.3}, {1.0, 0.0, 0.0, 0.0}};
                check(glm::distance(tool, (palm * trainer::fingertips_at_palm(xr::Side::right)).position) <
                          0.02,
                      "the hand is where the real one is");
                shown->done = true;
                return {};
        }
        return {};
    };
    DeskUser content(app, act);
    shown = &content;
    std::vector<std::string> log;
    xr::HeadsetOptions headset_options;
    headset_options.log = [&](const std::string& line) { log.push_back(line); };
    xr::Headset headset(std::move(headset_options));
    view::WindowRunOptions run;
    run.headset = &headset;
    run.adapts_resolution = false;
    const auto begun = std::chrono::steady_clock::now();
    run.stop = [&] { return std::chrono::steady_clock::now() - begun > std::chrono::minutes(8); };
    const std::vector<const char*> extensions = test::need(program.desktop.vulkan_extensions());
    run.instance.validation = true;
    run.instance.extensions = extensions;
    const Status done = view::run_in_window(content, program.window, *program.instance, run);
    for (const std::string& line : log) MESSAGE(line);
    CHECK_MESSAGE(done.has_value(), (done ? "" : done.error().message()));
    for (const std::string& failure : failures) FAIL_CHECK("not so: " << failure);
    CHECK_MESSAGE(content.done, "the last step was " << static_cast<int>(step));
}

}  // namespace

TEST_CASE("Lost headset: the lesson goes on in the window with the mouse, and returns to the headset") {
    play(true);
}

TEST_CASE("Lost headset: if its session cannot start, the mouse plays until it can") { play(false); }
