#include "tools/author/preview/hands.hpp"

#include <doctest/doctest.h>

#include <glm/geometric.hpp>

using namespace bolt;
using namespace bolt::author;
using namespace bolt::platform;

namespace {

const render::BoundingBox box{{-0.2F, -0.1F, -0.3F}, {0.4F, 0.3F, 0.1F}};

struct AtWork {
    Hands hands;
    view::Orbit camera;

    // A window of 800 × 400.
    Wishes do_(std::vector<Event> events) { return hands.apply(events, 400.0, 2.0, camera, box); }
};

KeyEvent pressed(Key key) { return {key, true, false, {}}; }

}  // namespace

TEST_CASE("keys: each what it stands for, once a press, and none of a desktop's short cuts") {
    AtWork at;
    CHECK(at.do_({pressed(Key::escape)}).close);
    CHECK(at.do_({pressed(Key::f11)}).full_screen);
    CHECK(at.do_({pressed(Key::r)}).reload);
    CHECK(at.do_({pressed(Key::f)}).all);
    CHECK(at.do_({pressed(Key::l)}).other_level);
    CHECK(at.do_({pressed(Key::digit_1)}).view == std::size_t{0});
    CHECK(at.do_({pressed(Key::digit_9)}).view == std::size_t{8});
    CHECK_FALSE(at.do_({pressed(Key::digit_0)}).view.has_value());
    CHECK_FALSE(at.do_({KeyEvent{Key::escape, false, false, {}}}).close);
    CHECK_FALSE(at.do_({KeyEvent{Key::f11, true, true, {}}}).full_screen);
    CHECK_FALSE(at.do_({KeyEvent{Key::r, true, false, {false, true, false, false}}}).reload);
    CHECK(at.do_({CloseEvent{}}).close);
    CHECK(at.do_({ResizeEvent{10, 10}}).redraw);
    CHECK(at.do_({RefreshEvent{}}).redraw);
    CHECK_FALSE(at.do_({CursorEvent{{3, 3}}}).redraw);
}

TEST_CASE("dragging: left turns, right and middle move, and letting go ends it") {
    AtWork at;
    (void)at.do_({CursorEvent{{100, 100}}});
    CHECK(at.camera.yaw == 0.0);  // nothing is held
    (void)at.do_({ButtonEvent{Button::left, true, {100, 100}}, CursorEvent{{140, 100}}});
    CHECK(at.camera.yaw == doctest::Approx(-0.1 * pi));  // a tenth of the height
    // Another button while one is held does not take over, and its release does not end it.
    (void)at.do_({ButtonEvent{Button::right, true, {140, 100}}, ButtonEvent{Button::right, false, {140, 100}},
                  CursorEvent{{140, 140}}});
    CHECK(at.camera.pitch == doctest::Approx(0.1 * pi));
    CHECK(glm::length(at.camera.target) == 0.0);
    (void)at.do_({ButtonEvent{Button::left, false, {140, 140}}, CursorEvent{{300, 300}}});
    CHECK(at.camera.yaw == doctest::Approx(-0.1 * pi));
    for (const Button button : {Button::right, Button::middle}) {
        AtWork other;
        (void)other.do_({ButtonEvent{button, true, {0, 0}}, CursorEvent{{0, -40}}});
        CHECK(other.camera.target.y < -0.01);  // the model goes up with the cursor
        CHECK(other.camera.yaw == 0.0);
    }
    // Focus lost while dragging: the button is let go somewhere else.
    AtWork third;
    (void)third.do_({ButtonEvent{Button::left, true, {0, 0}}, FocusEvent{false}, CursorEvent{{50, 0}}});
    CHECK(third.camera.yaw == 0.0);
}

TEST_CASE("the wheel goes to the cursor") {
    AtWork at;
    (void)at.do_({WheelEvent{{0, 1}, {400, 200}}});  // the middle
    CHECK(at.camera.distance == doctest::Approx(0.88));
    CHECK(glm::length(at.camera.target) == doctest::Approx(0.0));
    (void)at.do_({WheelEvent{{0, 1}, {800, 0}}});  // the upper right corner
    CHECK(at.camera.target.x > 0.01);
    CHECK(at.camera.target.y > 0.01);
    CHECK(at.camera.target.x == doctest::Approx(2.0 * at.camera.target.y));
}

TEST_CASE("the help names views by their keys, nine at most") {
    std::vector<view::Viewpoint> views(11);
    views[0].name = "overview";
    views[10].name = "eleventh";
    CHECK(help(views).find("1: overview") != std::string::npos);
    CHECK(help(views).find("eleventh") == std::string::npos);
    CHECK(help({}).find(" 1:") == std::string::npos);
}
