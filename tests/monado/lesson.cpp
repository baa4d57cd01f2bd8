// Whole lessons in a headset of Monado, whose remote driver gets the trainee's poses. tests/monado.sh runs
// them.
//
// BOLT_MONADO_PICTURES: a folder for pictures of both eyes.
#include <cstdlib>
#include <exception>
#include <iterator>

#include "game/session/session_file.hpp"
#include "tests/monado/headset_driver.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer_window/program.hpp"

using namespace bolt;

namespace {

constexpr VkExtent2D window_size{320, 240};
constexpr double longest_lesson = 900.0;  // s

// Plays the lesson in the headset until `act` is done; the lesson's outcome and log stay in `program`.
Status play_in_headset(test::Program& program, test::HeadsetDriver& driver, std::vector<std::string>& log,
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
    const std::vector<const char*> extensions = test::need(program.desktop.vulkan_extensions());
    run.instance.validation = true;
    run.instance.extensions = extensions;
    const Status done = view::run_in_window(driver, program.window, *program.instance, run);
    driver.turns().end_program();
    user_thread.join();
    if (thrown) std::rethrow_exception(thrown);
    return done;
}

// Fingers that the runtime simulates around a controller: how far the program finds them closed.
double closing_by_fingers(test::HeadsetDriver& driver, const Pose& head, float bent) {
    xr::Hands hands;
    xr::HandInput& hand = hands[xr::Side::left];
    hand.active = true;
    hand.grip = xr::TrackedPose{{{-0.4, 1.3, -0.2}, {1.0, 0.0, 0.0, 0.0}}, true};
    hand.joints.emplace();
    hand.grasp = bent;
    for (int i = 0; i < 3; ++i) driver.frame(head, hands);
    xr::HandInput received = driver.received()[xr::Side::left];
    REQUIRE(received.joints);
    received.grasp = 0.0F;
    return trainer::closing(received);
}

void play_lesson(const std::string& assembly) {
    auto remote = test::RemoteHeadset::connect();
    if (!remote) return test::skip_rest(remote.error().message());
    trainer::AppOptions options;
    options.choice.assembly = assembly;
    options.choice.equipment.hand = trainer::HandMode::tracked;
    options.menu = false;
    options.lesson.obstacles = session::Obstacles::if_any;
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / assembly;
    test::Program program(std::move(options), {window_size.width, window_size.height});
    test::HeadsetDriverOptions how;
    how.draw_interval = 0.2;
    if (const char* pictures = std::getenv("BOLT_MONADO_PICTURES"))
        how.pictures = std::filesystem::path(pictures) / assembly;
    test::HeadsetDriver driver(*program.app, std::move(*remote), how);
    test::TraineeInRoom trainee(driver);
    std::vector<std::string> log;
    double lesson_time = 0.0;  // s
    const Status run = play_in_headset(program, driver, log, [&] {
        while (driver.app().screen() != trainer::ShownScreen::lesson) driver.frame(trainee.head, {});
        MESSAGE("fingers open " << closing_by_fingers(driver, trainee.head, 0.0F) << ", half "
                                << closing_by_fingers(driver, trainee.head, 0.5F) << ", closed "
                                << closing_by_fingers(driver, trainee.head, 1.0F));
        trainee.play(longest_lesson);
        lesson_time = driver.app().lesson()->session->time();
        for (int i = 0; i < 10; ++i) driver.frame(trainee.head, {});  // the result
    });
    for (const std::string& line : log) MESSAGE(line);
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
    const test::HeadsetFrames& frames = driver.frames();
    MESSAGE(assembly << ": " << frames.count << " frames in " << frames.seconds << " s, lesson time "
                     << lesson_time << " s, " << trainee.approaches
                     << " approaches, largest distance of the hand " << frames.grip_error << " m");
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

}  // namespace

TEST_CASE("Monado: first-nut is played by a driven hand") { play_lesson("first-nut"); }
TEST_CASE("Monado: cover-m8 is played by a driven hand") { play_lesson("cover-m8"); }
