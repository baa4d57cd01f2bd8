// The free hand: the mouse moves and turns the hand, which feels the forces of a simulated arm.
#include <doctest/doctest.h>

#include "game/scene/annotations.hpp"
#include "game/session/session_file.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/free_hand_user.hpp"
#include "tests/trainer_app/hand_comparison.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

AppOptions free_hand(const char* assembly) {
    AppOptions o = test::options(assembly, false);
    o.choice.equipment.hand = HandMode::free;
    return o;
}

// Length of the arrow that shows the force on the hand, m; 0: hidden.
double shown_force(ActiveLesson& active) {
    double length = 0.0;
    active.workplace.world.view<const scene::ArrowMarker, const scene::Transform>().each(
        [&](const scene::ArrowMarker& marker, const scene::Transform& transform) {
            if (marker.shown && marker.meaning == scene::ArrowMeaning::force)
                length = static_cast<double>(glm::length(glm::vec3(transform.world[2])));
        });
    return length;
}

}  // namespace

TEST_CASE("Free hand: a simulated user aligns and tightens the nut by dragging alone") {
    if (test::sanitized) return test::skip_rest("a nut by hand takes minutes under a sanitizer");
    HeadlessTrainer driver(free_hand("first-nut"), {{320, 180}, 0.3F, 0.05});
    driver.frame();
    REQUIRE(driver.lesson().station);
    test::FreeHandUser user(driver);
    double longest = 0.0, greatest = 0.0;  // m, N
    bool switched_off = false;
    user.on_frame = [&] {
        if (driver.app().screen() != ShownScreen::lesson) return;
        auto& active = const_cast<ActiveLesson&>(driver.lesson());
        longest = std::max(longest, shown_force(active));
        greatest = std::max(greatest, glm::length(active.station->latest.output.force));
        if (switched_off || shown_force(active) < 0.02) return;
        switched_off = true;
        active.force.enabled = false;
        driver.frame({}, 1e-3);
        CHECK(shown_force(active) == 0.0);
        active.force.enabled = true;
    };
    user.play(120.0);
    CHECK(switched_off);
    // A tight nut is seen.
    CHECK(greatest > 3.0);
    CHECK(longest > 0.5 * scene::force_arrow_length * greatest);
    CHECK(longest <= scene::force_arrow_length * greatest * (1.0 + 1e-6));
    CHECK(driver.app().screen() == ShownScreen::result);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
    CHECK(user.presses < 20);  // the picture is small, and at its edge the user presses anew
}

TEST_CASE("Free hand: a left-hand thread is tightened by dragging and turning the other way") {
    if (test::sanitized) return test::skip_rest("a nut by hand takes minutes under a sanitizer");
    const test::OneJoint one("cover-m8", "left");
    AppOptions o = free_hand(one.name().c_str());
    o.out = one.folder() / "out";
    HeadlessTrainer driver(o, {{320, 180}, 0.3F, 0.05});
    driver.frame();
    test::FreeHandUser user(driver);
    user.play(120.0);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
}

TEST_CASE("Free hand: fingers and wrench leave a nut without a mistake, and go to the next among obstacles") {
    if (test::sanitized) return test::skip_rest("four nuts by hand take minutes under a sanitizer");
    HeadlessTrainer driver(free_hand("cover-m8"), {{320, 180}, 0.3F, 0.05});
    driver.frame();
    test::FreeHandUser user(driver);
    user.play(120.0, 5);  // four nuts run down, one tightened
    const session::LessonSession& session = *driver.lesson().session;
    CHECK(session.lesson().current >= 5);
    for (const lesson::JointTrack& track : session.lesson().joints) {
        CHECK(track.result.done_already == 0);
        CHECK(track.result.out_of_turn == 0);
        CHECK(track.slip_count == 0);
    }
}

TEST_CASE("Free hand: the helped and the free hand play the lessons of the comparison") {
    if (!test::compares_hands())
        return test::skip_rest("it takes the minutes of lessons; BOLTWRIGHT_COMPARE_HANDS=1 plays them");
    const test::OneJoint bolt("zq350");
    for (const auto& [name, assembly] :
         {std::pair<std::string, std::string>{"cover-m8", "cover-m8"}, {"ZQ350, one bolt", bolt.name()}})
        for (const auto hand : {HandMode::helped, HandMode::free}) {
            AppOptions options = test::options(assembly.c_str(), false);
            options.choice.equipment.hand = hand;
            const std::string label = hand == HandMode::free ? "free" : "helped";
            options.out = std::filesystem::path(BOLT_TRAINER_OUT) / ("headless_" + label);
            HeadlessTrainer driver(std::move(options), {{320, 180}, 0.3F, 0.05});
            driver.frame();
            const int presses = test::play_with_hand(driver, hand, 900.0);
            for (int i = 0; i < 3; ++i) driver.frame();
            const test::HandMeasures played =
                test::measure_hand(driver, driver.folder() / "session.boltwright", presses);
            MESSAGE(test::table_row(name + ", " + label, played));
            CHECK(played.finished);
            CHECK(played.score >= 80.0);
        }
}
