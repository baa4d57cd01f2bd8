// The trainer between projection walls, without windows: what stands where, and who moves the pointer.
#include <doctest/doctest.h>

#include "tests/room/immersive_driver.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

constexpr VkExtent2D wall_size{160, 120};

// A viewer who is expected 2 m in front of a wall that shows only what is above a line of sight.
view::ImmersiveFrame in_front_of_wall(double lowest_sight) {
    view::ImmersiveFrame immersive = test::standing_user(wall_size);
    immersive.tracked = false;
    immersive.head.position += Vec3(0.5, 0.1, -0.3);
    immersive.expected_head = test::standing_head();
    immersive.tracks_hands = false;
    const Vec3 eye = immersive.expected_head->position;
    immersive.shows = [eye, lowest_sight](const Vec3& point) {
        const Vec3 along = point - eye;
        return along.z < 0.0 && along.y / -along.z > lowest_sight;
    };
    return immersive;
}

double distance_of_workpiece(double lowest_sight) {
    HeadlessTrainer driver(test::options("cover-m8", false), {wall_size, 0.3F, 0.02});
    driver.immersive = in_front_of_wall(lowest_sight);
    driver.frame();
    // Already in the first frame of the lesson, which is shown.
    REQUIRE(driver.app().lesson() != nullptr);
    REQUIRE(driver.app().room()->workpiece);
    const Vec3 position = driver.app().room()->workpiece->position;
    driver.immersive->head.position += Vec3(0.1, 0.0, 0.2);
    driver.frame();
    CHECK(driver.app().room()->workpiece->position == position);
    return -position.z;
}

}  // namespace

TEST_CASE("Walls: the workpiece stands where the walls show it to the expected head, wherever the head is") {
    const double all = distance_of_workpiece(-100.0), some = distance_of_workpiece(-0.6);
    CHECK(some > all + 0.3);
    // A wall that never shows it changes nothing.
    CHECK(distance_of_workpiece(100.0) == doctest::Approx(all));
}

TEST_CASE("Walls: the menu is a panel on the walls, and the window's pointer presses its buttons") {
    HeadlessTrainer driver(test::options("first-nut", true), {panel_extent, 1.0F, 0.02});
    driver.immersive = in_front_of_wall(-100.0);
    driver.draws = true;
    for (int i = 0; i < 3; ++i) driver.frame();
    REQUIRE(driver.app().room()->plays_in_room);
    REQUIRE(driver.app().room()->panel);  // without a tracker that sees the head
    glm::dvec2 start(0.0);
    for (const DrawnWidget& widget : driver.app().drawn_widgets())
        if (widget.label == words::TextKey("menu.start")) start = widget.middle;
    REQUIRE(start.x > 0.0);
    driver.press(start);
    driver.release(start);
    for (int i = 0; i < 3; ++i) driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    // The lesson is played by mouse in the window; the walls show it.
    CHECK_FALSE(driver.app().room()->plays_in_room);
    CHECK(driver.app().room()->workpiece);
}

TEST_CASE("Walls: the panel is where and as large as the display shows it whole") {
    HeadlessTrainer driver(test::options("first-nut", true), {panel_extent, 1.0F, 0.02});
    driver.draws = false;
    driver.immersive = in_front_of_wall(-100.0);
    driver.immersive->panel = view::PanelPlace{{{0.1, 1.4, -1.5}, rotation({0.0, 0.2, 0.0})}, 0.7e-3};
    driver.frame();
    const RoomState& room = *driver.app().room();
    REQUIRE(room.panel);
    CHECK(room.panel->position == driver.immersive->panel->pose.position);
    CHECK(room.panel->orientation == driver.immersive->panel->pose.orientation);
    CHECK(room.panel_point_size == 0.7e-3);
}

TEST_CASE("Walls: keys and buttons of the pause turn and raise the workpiece, also in a lesson by mouse") {
    HeadlessTrainer driver(test::options("first-nut", false), {{640, 700}, 1.0F, 0.02});
    driver.draws = false;
    driver.immersive = in_front_of_wall(-100.0);
    driver.frame();
    REQUIRE(driver.app().room()->workpiece);
    const auto room = [&]() -> const RoomState& { return *driver.app().room(); };
    driver.key(platform::Key::l);
    driver.key(platform::Key::l);
    driver.key(platform::Key::j);
    CHECK(room().turns == 1);
    for (int i = 0; i < 3; ++i) driver.key(platform::Key::plus);
    driver.key(platform::Key::minus);
    CHECK(room().height == doctest::Approx(2 * raise_step));
    for (int i = 0; i < 20; ++i) driver.key(platform::Key::plus);
    CHECK(room().height == doctest::Approx(0.4));
    driver.key(platform::Key::b);
    CHECK(room().turns == 0);
    CHECK(room().height == 0.0);
    driver.key(platform::Key::l);
    driver.draws = true;
    driver.draw_interval = 1;
    driver.key(platform::Key::escape);
    driver.frame();
    driver.frame();
    for (const auto& [label, turns] : {std::pair{words::TextKey("action.turn_right"), 2},
                                       std::pair{words::TextKey("action.turn_left"), 1}}) {
        glm::dvec2 at(0.0);
        for (const DrawnWidget& widget : driver.app().drawn_widgets())
            if (widget.label == label) at = widget.middle;
        REQUIRE(at.x > 0.0);
        driver.press(at);
        driver.release(at);
        for (int i = 0; i < 3; ++i) driver.frame();
        CHECK(room().turns == turns);
    }
}

TEST_CASE("Walls: a wand points at the panel, presses its buttons, pauses, and its ray is drawn") {
    AppOptions options = test::options("cover-m8", true);
    options.choice.equipment.glove = "/dev/null";  // a lesson with devices is played before the walls
    HeadlessTrainer driver(options, {panel_extent, 1.0F, 0.02});
    driver.immersive = in_front_of_wall(-100.0);
    // As large as a cave shows it: twice a headset's.
    driver.immersive->panel = view::PanelPlace{{{0.1, 1.4, -1.5}, rotation({0.0, 0.2, 0.0})}, 2.0e-3};
    driver.draws = true;
    for (int i = 0; i < 3; ++i) driver.frame();
    const RoomState& room = *driver.app().room();
    REQUIRE(room.panel);
    glm::dvec2 language(0.0);
    for (const DrawnWidget& widget : driver.app().drawn_widgets())
        if (widget.label == words::TextKey("menu.settings")) language = widget.middle;
    REQUIRE(language.x > 0.0);
    // From the hip, askew.
    const Vec3 from(0.3, 1.1, 0.1), target = point_on_panel({*room.panel, 2.0e-3}, language);
    const Vec3 z = glm::normalize(from - target), x = glm::normalize(glm::cross(Vec3(0, 1, 0), z));
    xr::HandInput& wand = driver.immersive->hands[Side::right];
    wand.active = true;
    wand.aim = xr::ReportedPose{{from, glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z))}, true};
    driver.frame();
    CHECK(room.pointer.on_panel);
    CHECK(glm::length(room.pointer.at - language) < 0.5);
    REQUIRE(driver.app().room_hands() != nullptr);  // with the model of the ray
    for (const float select : {1.0F, 1.0F, 0.0F, 0.0F}) {
        wand.select = select;
        driver.frame();
    }
    CHECK(driver.app().shows_settings());
    // Without a wand there is no pointer.
    wand = {};
    driver.frame();
    CHECK_FALSE(room.pointer.on_panel);
}
