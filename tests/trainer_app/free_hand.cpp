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
    MESSAGE("time ", driver.lesson().session->time(), " s, presses ", user.presses);
    CHECK(driver.app().screen() == ShownScreen::result);
}
