// The free hand: the mouse moves and turns the hand, which feels the forces of a simulated arm.
#include <doctest/doctest.h>

#include "game/session/session_file.hpp"
#include "tests/trainer_app/free_hand_user.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

AppOptions free_hand(const char* assembly) {
    AppOptions o = test::options(assembly, false);
    o.choice.equipment.hand = HandMode::free;
    return o;
}

}  // namespace

TEST_CASE("Free hand: a simulated user aligns and tightens the nut by dragging alone") {
    HeadlessTrainer driver(free_hand("first-nut"), {{320, 180}, 0.3F, 0.05});
    driver.frame();
    REQUIRE(driver.lesson().station);
    test::FreeHandUser user(driver);
    user.play(120.0);
    CHECK(driver.app().screen() == ShownScreen::result);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
    CHECK(user.presses < 10);
}

TEST_CASE("Free hand: fingers and wrench leave a nut without a mistake, and go to the next among obstacles") {
    HeadlessTrainer driver(free_hand("cover-m8"), {{320, 180}, 0.3F, 0.05});
    driver.frame();
    test::FreeHandUser user(driver);
    user.play(120.0, 6);  // four nuts run down, two tightened
    const session::LessonSession& session = *driver.lesson().session;
    CHECK(session.lesson().current >= 6);
    for (const lesson::JointTrack& track : session.lesson().joints) {
        CHECK(track.result.done_already == 0);
        CHECK(track.result.out_of_turn == 0);
        CHECK(track.slip_count == 0);
    }
}
