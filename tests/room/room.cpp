// Lessons in a room: head and hands of a headset, without the headset.
#include <doctest/doctest.h>

#include "tests/room/trainee_in_room.hpp"
#include "tests/trainer/one_joint.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

constexpr VkExtent2D eye_size{160, 120};

AppOptions tracked_hand(const char* assembly) {
    AppOptions o = test::options(assembly, false);
    o.choice.equipment.hand = HandMode::tracked;
    return o;
}

}  // namespace

TEST_CASE("Room: workpiece and panel stand in front of the user, and stay when the head moves") {
    HeadlessTrainer driver(tracked_hand("cover-m8"), {eye_size, 0.3F, 0.02});
    driver.immersion = test::standing_user(eye_size);
    driver.frame();
    driver.frame();
    REQUIRE(driver.app().room());
    const Room room = *driver.app().room();
    REQUIRE(room.workpiece);
    REQUIRE(room.panel);
    driver.immersion->head.position += Vec3(0.2, -0.1, 0.1);
    driver.immersion->groups = {test::two_eyes(driver.immersion->head, eye_size)};
    driver.frame();
    CHECK(driver.app().room()->workpiece->position == room.workpiece->position);
    CHECK(driver.app().room()->panel->position == room.panel->position);
    if (const char* folder = std::getenv("BOLT_ROOM_PICTURES")) {
        const render::Picture eyes[] = {driver.room_picture(0), driver.room_picture(1)};
        (void)view::write_picture(view::side_by_side(eyes), std::filesystem::path(folder) / "room.png");
    }
}

TEST_CASE("Room: a tracked hand runs a nut down with its fingers, takes the wrench, aligns it and tightens") {
    HeadlessTrainer driver(tracked_hand("first-nut"), {eye_size, 0.3F, 0.02});
    driver.immersion = test::standing_user(eye_size);
    driver.frame();
    REQUIRE(driver.lesson().station);
    test::TraineeInRoom trainee(driver);
    trainee.play(120.0);
    CHECK(driver.app().screen() == ShownScreen::result);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
    MESSAGE("score " << driver.outcome()->result.score << ", approaches " << trainee.approaches);
}
