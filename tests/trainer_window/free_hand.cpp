// The free hand in a real window: mouse buttons, pointer and wheel go through the X server.
//
//   BOLTWRIGHT_COMPARE_HANDS=1 tests/with_screen.sh test_trainer_window -tc='Window: *hand*'
//
// also plays the lessons of the comparison in docs/performance.md with both hands, in real time.
#include "game/session/session_file.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/hand_comparison.hpp"
#include "tests/trainer_window/program.hpp"
#include "tests/trainer_window/window_driver.hpp"

using namespace bolt;

namespace {

constexpr double longest_lesson = 900.0;  // s

test::HandMeasures play(const std::string& assembly, const std::string& out, trainer::HandMode hand) {
    trainer::AppOptions options;
    options.choice.assembly = assembly;
    options.choice.equipment.hand = hand;
    options.menu = false;
    options.lesson.obstacles = session::ObstacleUse::if_any;
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / out;
    test::Program program(std::move(options), {320, 200});
    test::WindowDriver driver(*program.app, program.window);
    int presses = 0;
    test::need(test::run_with_user(program, driver, [&] {
        while (driver.app().screen() != trainer::ShownScreen::lesson) driver.frame();
        presses = test::play_with_hand(driver, hand, longest_lesson);
        for (int i = 0; i < 3; ++i) driver.frame();
    }));
    return test::measure_hand(driver, program.out / "session.boltwright", presses);
}

}  // namespace

TEST_CASE("Window: a simulated user aligns the wrench and tightens a bolt with the free hand") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const test::OneJoint one("cover-m8");
    const test::HandMeasures played = play(one.name(), "free_hand", trainer::HandMode::free);
    MESSAGE(test::table_row("cover-m8, one bolt, free", played));
    CHECK(played.finished);
    CHECK(played.score >= 80.0);
    REQUIRE(played.torque_error);
    CHECK(*played.torque_error < 0.1);
}

TEST_CASE("Window: the helped and the free hand play the lessons of the comparison") {
    if (!test::compares_hands())
        return test::skip_rest("it takes the minutes of lessons; BOLTWRIGHT_COMPARE_HANDS=1 plays them");
    const test::OneJoint bolt("zq350");
    for (const auto& [name, assembly] :
         {std::pair<std::string, std::string>{"cover-m8", "cover-m8"}, {"ZQ350, one bolt", bolt.name()}})
        for (const auto hand : {trainer::HandMode::helped, trainer::HandMode::free}) {
            const std::string label = hand == trainer::HandMode::free ? "free" : "helped";
            const test::HandMeasures played = play(assembly, "window_" + label, hand);
            MESSAGE(test::table_row(name + ", " + label + ", X server", played));
            CHECK(played.finished);
            CHECK(played.score >= 80.0);
        }
}
