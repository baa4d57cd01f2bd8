#include "tools/author/preview/controls.hpp"

#include <doctest/doctest.h>

#include <glm/geometric.hpp>

using namespace bolt;
using namespace bolt::author;
using namespace bolt::platform;

namespace {

const render::BoundingBox box{{-0.2F, -0.1F, -0.3F}, {0.4F, 0.3F, 0.1F}};

struct ControlsFixture {
    PreviewControls hands;
    view::Orbit camera;

    // The window has 800 × 400 pixels.
    PreviewCommands apply(std::vector<InputEvent> events) {
        return hands.apply(events, 400.0, 2.0, camera, box);
    }
};

KeyEvent pressed(Key key) { return {key, true, false, {}}; }

}  // namespace

TEST_CASE("Preview: each key gives its command once, and not with a modifier") {
    ControlsFixture at;
    CHECK(at.apply({pressed(Key::escape)}).close);
    CHECK(at.apply({pressed(Key::f11)}).full_screen);
    CHECK(at.apply({pressed(Key::r)}).reload);
    CHECK(at.apply({pressed(Key::f)}).show_all);
    CHECK(at.apply({pressed(Key::l)}).toggle_level);
    CHECK(at.apply({pressed(Key::s)}).toggle_sectors);
    CHECK(at.apply({pressed(Key::n)}).next_problem);
    CHECK(at.apply({pressed(Key::v)}).next_variant);
    CHECK(at.apply({pressed(Key::p)}).toggle_panel);
    CHECK(at.apply({pressed(Key::digit_1)}).select_view == std::size_t{0});
    CHECK(at.apply({pressed(Key::digit_9)}).select_view == std::size_t{8});
    CHECK_FALSE(at.apply({pressed(Key::digit_0)}).select_view.has_value());
    CHECK_FALSE(at.apply({KeyEvent{Key::escape, false, false, {}}}).close);
    CHECK_FALSE(at.apply({KeyEvent{Key::f11, true, true, {}}}).full_screen);
    CHECK_FALSE(at.apply({KeyEvent{Key::r, true, false, {false, true, false, false}}}).reload);
    CHECK(at.apply({CloseEvent{}}).close);
    CHECK(at.apply({ResizeEvent{10, 10}}).redraw);
    CHECK(at.apply({RefreshEvent{}}).redraw);
    CHECK_FALSE(at.apply({CursorEvent{{3, 3}}}).redraw);
}

TEST_CASE("Preview: left drag turns, right and middle drag move, and the release ends the drag") {
    ControlsFixture at;
    (void)at.apply({CursorEvent{{100, 100}}});
    CHECK(at.camera.yaw == 0.0);  // no button is held
    (void)at.apply({ButtonEvent{Button::left, true, {100, 100}}, CursorEvent{{140, 100}}});
    CHECK(at.camera.yaw == doctest::Approx(-0.1 * pi));  // a tenth of the height
    // A second button neither changes nor ends the drag.
    (void)at.apply({ButtonEvent{Button::right, true, {140, 100}},
                    ButtonEvent{Button::right, false, {140, 100}}, CursorEvent{{140, 140}}});
    CHECK(at.camera.pitch == doctest::Approx(0.1 * pi));
    CHECK(glm::length(at.camera.target) == 0.0);
    (void)at.apply({ButtonEvent{Button::left, false, {140, 140}}, CursorEvent{{300, 300}}});
    CHECK(at.camera.yaw == doctest::Approx(-0.1 * pi));
    for (const Button button : {Button::right, Button::middle}) {
        ControlsFixture other;
        (void)other.apply({ButtonEvent{button, true, {0, 0}}, CursorEvent{{0, -40}}});
        CHECK(other.camera.target.y < -0.01);  // the model goes up with the cursor
        CHECK(other.camera.yaw == 0.0);
    }
    // Loss of focus ends the drag, because the release goes to another window.
    ControlsFixture third;
    (void)third.apply({ButtonEvent{Button::left, true, {0, 0}}, FocusEvent{false}, CursorEvent{{50, 0}}});
    CHECK(third.camera.yaw == 0.0);
}

TEST_CASE("Preview: the wheel zooms towards the cursor") {
    ControlsFixture at;
    (void)at.apply({WheelEvent{{0, 1}, {400, 200}}});  // the middle
    CHECK(at.camera.distance == doctest::Approx(0.88));
    CHECK(glm::length(at.camera.target) == doctest::Approx(0.0));
    (void)at.apply({WheelEvent{{0, 1}, {800, 0}}});  // the upper right corner
    CHECK(at.camera.target.x > 0.01);
    CHECK(at.camera.target.y > 0.01);
    CHECK(at.camera.target.x == doctest::Approx(2.0 * at.camera.target.y));
}

TEST_CASE("Preview: a click is a press and a release of the left button without a drag between them") {
    ControlsFixture at;
    const auto button = [](Button which, bool down, double x) { return ButtonEvent{which, down, {x, 100}}; };
    const auto left = [&](bool down, double x) { return button(Button::left, down, x); };
    CHECK(at.apply({left(true, 200), left(false, 200)}).click == glm::dvec2(200, 100));
    CHECK_FALSE(at.apply({left(true, 200), CursorEvent{{202, 100}}}).click.has_value());
    CHECK(at.apply({left(false, 202)}).click.has_value());
    CHECK_FALSE(
        at.apply({left(true, 200), CursorEvent{{300, 100}}, CursorEvent{{200, 100}}, left(false, 200)})
            .click.has_value());
    CHECK_FALSE(at.apply({button(Button::right, true, 200), button(Button::right, false, 200)}).click);
    CHECK_FALSE(at.apply({left(true, 200), button(Button::right, true, 200), left(false, 200)}).click);
    CHECK_FALSE(at.apply({left(true, 200), FocusEvent{false}, left(false, 200)}).click);
}

TEST_CASE("Preview: the help names up to nine views by their keys") {
    std::vector<view::Viewpoint> views(11);
    views[0].name = "overview";
    views[10].name = "eleventh";
    CHECK(help_line(views).find("1: overview") != std::string::npos);
    CHECK(help_line(views).find("eleventh") == std::string::npos);
    CHECK(help_line({}).find(" 1:") == std::string::npos);
}
