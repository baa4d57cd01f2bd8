// When panel and workpiece of a room get their places, and when they are placed again.
#include <doctest/doctest.h>

#include "tests/room/immersive_driver.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

constexpr double frame_step = 0.05;  // s in a frame
const VkExtent2D placement_eyes = test::eye_size();

AppOptions room_options(bool menu) {
    AppOptions o = test::options("cover-m8", menu);
    o.choice.equipment.hand = HandMode::tracked;
    return o;
}

// A head at this place, turned about the vertical; positive: to the left.
Pose head_at(const Vec3& position, double turn_deg) {
    return {position, rotation({0.0, to_radians(turn_deg), 0.0})};
}
const Pose on_table = head_at({0.5, 0.78, 0.4}, 90.0), upright = head_at({0.0, 1.65, 0.0}, 0.0);

class PlacementRoom {
  public:
    explicit PlacementRoom(bool menu) : driver(room_options(menu), {placement_eyes, 0.3F, frame_step}) {
        driver.draws = false;
        driver.immersive = test::standing_user(placement_eyes);
    }
    void frames(const Pose& head, double seconds) {
        driver.immersive->head = head;
        driver.immersive->groups = {test::two_eyes(head, placement_eyes)};
        for (double passed = 0.0; passed < seconds - 1e-9; passed += frame_step) driver.frame();
    }
    [[nodiscard]] const RoomState& state() const { return *driver.app().room(); }
    // The panel is placed in front of this head.
    void check_panel_at(const Pose& head) const {
        REQUIRE(state().panel);
        const Vec3 seen = inverse(head) * state().panel->position;
        CHECK(glm::distance(seen, Vec3(0.0, -0.02, -panel_distance)) < 1e-6);
    }

    HeadlessTrainer driver;
};

}  // namespace

TEST_CASE("Placement: a headset on a table places nothing, and the head of its user does") {
    PlacementRoom room(true);
    room.frames(on_table, 2.0);
    CHECK_FALSE(room.state().panel);
    room.frames(upright, frame_step);
    room.check_panel_at(upright);
}

TEST_CASE("Placement: nothing is placed while the headset is not worn or not tracked") {
    for (const bool tracked : {false, true}) {
        CAPTURE(tracked);
        PlacementRoom room(true);
        room.driver.immersive->tracked = tracked;
        room.driver.immersive->attentive = !tracked;
        room.frames(head_at({2.0, 1.4, 0.0}, 90.0), 10.0);
        CHECK_FALSE(room.state().panel);
        room.driver.immersive->tracked = room.driver.immersive->attentive = true;
        room.frames(upright, frame_step);
        room.check_panel_at(upright);
    }
}

TEST_CASE(
    "Placement: with a floor that is set wrongly the panel comes after 3 s, and again at a normal height") {
    PlacementRoom room(true);
    const Pose low = head_at({0.0, 0.1, 0.0}, 0.0);
    room.frames(low, 2.9);
    CHECK_FALSE(room.state().panel);
    room.frames(low, 0.3);
    REQUIRE(room.state().panel);
    room.frames(upright, 2 * frame_step);
    room.check_panel_at(upright);
}

TEST_CASE(
    "Placement: a panel beside, behind or far from the user is placed again after 3 s, and not before") {
    const Pose away[] = {head_at(upright.position, 120.0), head_at(upright.position, -80.0),
                         head_at({0.0, 1.65, -1.5}, 0.0), head_at({0.0, 1.65, 3.0}, 0.0)};
    for (const Pose& head : away) {
        PlacementRoom room(true);
        room.frames(upright, 0.2);
        room.check_panel_at(upright);
        room.frames(head, 2.9);
        room.check_panel_at(upright);
        room.frames(head, 0.3);
        room.check_panel_at(head);
    }
    // A user who looks away for less, again and again, finds it where it was.
    PlacementRoom room(true);
    for (int i = 0; i < 5; ++i) {
        room.frames(upright, 0.2);
        room.frames(away[0], 2.5);
    }
    room.check_panel_at(upright);
    // The view turned up or down, or a little to the side, moves nothing.
    for (const Vec3& turn : {Vec3(-1.2, 0.0, 0.0), Vec3(1.2, 0.0, 0.0), Vec3(0.0, 1.0, 0.0)}) {
        room.frames({upright.position, rotation(turn)}, 5.0);
        room.check_panel_at(upright);
    }
}

TEST_CASE(
    "Placement: a workpiece that the user has never faced comes too, one at which the user worked stays") {
    for (const bool faced : {false, true}) {
        CAPTURE(faced);
        PlacementRoom room(false);
        room.frames(upright, frame_step);
        if (faced) room.frames(upright, 0.2);
        REQUIRE(room.state().workpiece);
        const Vec3 before = room.state().workpiece->position;
        // The user who worked walks to the other side of the workpiece, the other one has another front.
        const Pose away = faced ? head_at({0.0, 1.65, -1.3}, 180.0) : head_at(upright.position, 170.0);
        room.frames(away, 3.2);
        room.check_panel_at(away);
        CHECK((room.state().workpiece->position == before) == faced);
    }
}

TEST_CASE(
    "Placement: recentring of any space, the key, the pause menu and a held menu button place all again") {
    const Pose moved = head_at({0.3, 1.5, 0.4}, 40.0);
    const auto check = [&](const char* how, const auto& act) {
        CAPTURE(how);
        PlacementRoom room(false);
        room.frames(upright, 0.2);
        const Vec3 workpiece = room.state().workpiece->position;
        room.frames(moved, 0.2);
        room.check_panel_at(upright);
        act(room);
        room.driver.immersive->recentred = false;
        room.frames(moved, 2 * frame_step);
        room.check_panel_at(moved);
        CHECK(glm::distance(room.state().workpiece->position, workpiece) > 0.1);
    };
    check("recentred", [&](PlacementRoom& room) {
        room.driver.immersive->recentred = true;
        room.frames(moved, frame_step);
    });
    check("key", [&](PlacementRoom& room) { room.driver.key(platform::Key::b); });
    check("button", [&](PlacementRoom& room) {
        room.driver.immersive->hands[xr::Side::left].active = true;
        room.driver.immersive->hands[xr::Side::left].menu = true;
        room.frames(moved, 0.9);
        room.check_panel_at(upright);
        room.frames(moved, 0.2);
        room.driver.immersive->hands[xr::Side::left].menu = false;
    });
    check("pause menu", [&](PlacementRoom& room) {
        room.driver.draws = true;
        room.driver.draw_interval = 1;
        room.driver.key(platform::Key::escape);
        room.frames(moved, 0.2);
        test::press_on_panel(room.driver, "action.place_again");
    });
}

TEST_CASE("Placement: a lesson that begins before its user wears the headset waits for the user") {
    PlacementRoom room(false);
    room.frames(on_table, 1.0);
    CHECK_FALSE(room.state().workpiece);
    CHECK(room.driver.lesson().clock.paused);
    CHECK(room.driver.lesson().session->time() < 0.1);
    room.frames(upright, 0.5);
    CHECK(room.state().workpiece);
    CHECK_FALSE(room.driver.lesson().clock.paused);
    CHECK(room.driver.lesson().session->time() > 0.2);
}

TEST_CASE("Placement: the workpiece stands where the real one is registered, and is not turned") {
    const Pose registered{{0.4, 0.82, -0.7}, rotation({0.0, 0.6, 0.0})};
    const auto options = [&](bool inverted) {
        AppOptions made = room_options(false);
        content::Registration one;
        one.from = content::CoordinateFrame::workpiece;
        one.pose = registered;
        if (inverted) std::swap(one.from, one.to);
        if (inverted) one.pose = inverse(registered);
        made.choice.equipment.station.registrations.push_back(one);
        return made;
    };
    for (const bool inverted : {false, true})
        for (const bool fixed : {true, false}) {
            CAPTURE(fixed);
            HeadlessTrainer driver(options(inverted), {placement_eyes, 0.3F, frame_step});
            driver.draws = false;
            driver.immersive = test::standing_user(placement_eyes);
            driver.immersive->fixed_in_room = fixed;
            for (int i = 0; i < 10; ++i) driver.frame();
            driver.frame({platform::KeyEvent{platform::Key::j, true}});  // turns the workpiece
            const Pose scene = driver.immersive->head * inverse(*driver.lesson().view.head);
            const double off = glm::distance(scene.position, registered.position) +
                               glm::length(turn_between(scene.orientation, registered.orientation));
            CHECK((off < 1e-9) == fixed);
            const auto logged = [&](std::string_view words) {
                return std::count_if(driver.log().begin(), driver.log().end(), [&](const std::string& line) {
                    return line.find(words) != std::string::npos;
                });
            };
            CHECK(logged("the workpiece stands where the real one is registered") == (fixed ? 1 : 0));
            CHECK(logged("the registered workpiece is not used") == (fixed ? 0 : 1));
        }
}
