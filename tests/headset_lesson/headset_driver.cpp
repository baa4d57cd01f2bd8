#include "tests/headset_lesson/headset_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "engine/gpu/resources.hpp"
#include "game/session/session_file.hpp"
#include "game/view/pictures.hpp"
#include "tests/support/need.hpp"

namespace bolt::test {

namespace {

// True for a frame of the headset that its user sees, and whose poses came from the runtime.
bool is_new(const view::WindowFrame& window) {
    return window.immersive != nullptr && window.immersive->attentive && !window.immersive->repeated;
}

}  // namespace

Status HeadsetDriver::start(view::GpuContext& gpu_context) {
    gpu_ = &gpu_context;
    return app_.start(gpu_context);
}

void HeadsetDriver::release() {
    app_.release();
    gpu_ = nullptr;
    drawn_.reset();
}

// Compares the poses from the runtime with those that were sent in the user's last turn.
void HeadsetDriver::compare(const view::ImmersiveFrame& immersive) {
    for (std::size_t side = 0; side < sent_.sides.size(); ++side) {
        const xr::HandInput &sent = sent_.sides[side], &got = immersive.hands.sides[side];
        if (!sent.active || !sent.grip) continue;
        if (!got.active || !got.grip) {
            ++frames_.without_hand;
            continue;
        }
        frames_.grip_error =
            std::max(frames_.grip_error, glm::distance(sent.grip->pose.position, got.grip->pose.position));
        if (std::abs(sent.grasp - got.grasp) > 1e-3F || std::abs(sent.select - got.select) > 1e-3F)
            frames_.unlike_trigger = true;
    }
}

Status HeadsetDriver::update(const view::WindowFrame& window) {
    view::WindowFrame stepped = window;
    stepped.seconds = options_.step;
    const auto now = std::chrono::steady_clock::now();
    const bool seen = is_new(window);
    if (seen) {
        compare(*window.immersive);
        received_ = window.immersive->hands;
        ++frames_.count;
        if (last_frame_) frames_.seconds += std::chrono::duration<double>(now - *last_frame_).count();
    }
    last_frame_ = seen ? std::optional(now) : std::nullopt;
    BOLT_TRY(take_picture());
    return app_.update(stepped);
}

Status HeadsetDriver::draw(gpu::FrameContext& frame, const view::WindowFrame& window) {
    const bool seen = is_new(window);
    const double time = app_.lesson() ? app_.lesson()->session->time() : 0.0;
    if (!seen) {  // a frame of the window alone, while the runtime is late
        newly_drawn_ = false;
        return app_.draw(frame, window);
    }
    newly_drawn_ = !drawn_ || app_.screen() != trainer::ShownScreen::lesson ||
                   time >= drawn_at_ + options_.draw_interval || time < drawn_at_;
    if (newly_drawn_) {
        drawn_at_ = time;
        BOLT_TRY(app_.draw(frame, window));
        if (!window.immersive->groups.empty()) drawn_ = window.immersive->groups.front().size;
    }
    user_done_ = turns_.give();
    return {};
}

// The pictures of the last frame, which were copied into the headset's.
Status HeadsetDriver::take_picture() {
    if (options_.pictures.empty() || !drawn_ || !newly_drawn_) return {};
    BOLT_TRY(gpu_->frames->finish());
    std::vector<render::Picture> eyes;
    for (std::uint32_t eye = 0; eye < 2; ++eye) {
        const render::ImageLayer made = gpu_->renderer->picture(eye, view::immersive_group);
        BOLT_TRY_ASSIGN(const auto texels,
                        gpu::download_image(*gpu_->device, *made.image, gpu::ResourceUse::transfer_from, 4, 0,
                                            made.layer));
        render::Picture& picture = eyes.emplace_back(render::Picture{drawn_->width, drawn_->height, {}});
        for (const std::byte b : texels) picture.rgba.push_back(static_cast<std::uint8_t>(b));
    }
    return view::write_picture(view::side_by_side(eyes),
                               options_.pictures / fmt::format("{:05}.png", pictures_++));
}

void HeadsetDriver::frame(const Pose& head, const xr::Hands& hands) {
    sent_ = hands;
    do {
        need(send_(head, hands));
        turns_.take();
    } while (options_.settled && !options_.settled());
}

Status play_in_headset(Program& program, HeadsetDriver& driver, std::vector<std::string>& log,
                       const std::function<void()>& act) {
    xr::HeadsetOptions options;
    options.log = [&](const std::string& line) { log.push_back(line); };
    xr::Headset headset(std::move(options));
    std::exception_ptr thrown;
    std::thread user_thread([&] {
        try {
            driver.turns().run(act);
        } catch (...) {
            thrown = std::current_exception();
        }
    });
    view::WindowRunOptions run;
    run.headset = &headset;
    run.adapts_resolution = false;
    const std::vector<const char*> extensions = need(program.desktop.vulkan_extensions());
    run.instance.validation = true;
    run.instance.extensions = extensions;
    const Status done = view::run_in_window(driver, program.window, *program.instance, run);
    driver.turns().end_program();
    user_thread.join();
    if (thrown) std::rethrow_exception(thrown);
    return done;
}

trainer::AppOptions headset_lesson_options(const std::string& assembly, const std::filesystem::path& out) {
    trainer::AppOptions options;
    options.choice.assembly = assembly;
    options.choice.equipment.hand = trainer::HandMode::tracked;
    options.menu = false;
    options.lesson.obstacles = session::ObstacleUse::if_any;
    options.out = out / assembly;
    return options;
}

void play_lesson_in_headset(Program& program, HeadsetDriver& driver,
                            const std::function<void(const Pose& head)>& before) {
    constexpr double longest_lesson = 900.0;  // s
    TraineeInRoom trainee(driver);
    std::vector<std::string> log;
    double lesson_time = 0.0;  // s
    const Status run = play_in_headset(program, driver, log, [&] {
        while (driver.app().screen() != trainer::ShownScreen::lesson) driver.frame(trainee.head, {});
        if (before) before(trainee.head);
        trainee.play(longest_lesson);
        lesson_time = driver.app().lesson()->session->time();
        for (int i = 0; i < 10; ++i) driver.frame(trainee.head, {});  // the result
    });
    for (const std::string& line : log) MESSAGE(line);
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
    const HeadsetFrames& frames = driver.frames();
    MESSAGE(frames.count << " frames in " << frames.seconds << " s, lesson time " << lesson_time << " s, "
                         << trainee.approaches << " approaches, largest distance of the hand "
                         << frames.grip_error << " m");
    CHECK(frames.without_hand < 10);
    REQUIRE(program.played);
    const lesson::LessonResult& result = program.played->result;
    MESSAGE("score " << result.score);
    CHECK(result.finished);
    CHECK(result.score >= 80.0);
    for (const lesson::JointResult& joint : result.joints) CHECK(joint.overall == lesson::Verdict::ok);
    const auto reader = session::SessionReader::open(program.out / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
}

}  // namespace bolt::test
