// The panel of menus and hints on walls: its size, and that no edge of a wall cuts it.
#include "content/displays/panel_fit.hpp"

#include <doctest/doctest.h>

#include "content/displays/example_displays.hpp"
#include "content/displays/wall_geometry.hpp"
#include "tests/displays/support.hpp"

using namespace bolt;
using namespace bolt::content;
using namespace displays_test;

namespace {

PanelFit fit_inside(const DisplayFile& file) {
    const auto fit = fit_panel(file.walls, file.head.fixed_head);
    REQUIRE(fit.has_value());
    const WallAxes wall = axes_of(file.walls[fit->wall]);
    for (const double x : {-0.5, 0.5})
        for (const double y : {-0.5, 0.5}) {
            const Vec3 corner =
                fit->pose * (fit->point_size * Vec3(x * panel_width_points, y * panel_height_points, 0.0));
            const double right = glm::dot(corner - wall.origin, wall.right),
                         up = glm::dot(corner - wall.origin, wall.up);
            CHECK(std::abs(distance_in_front(wall, corner)) < 1e-9);
            CHECK((right > 0.0 && right < wall.width));
            CHECK((up > 0.0 && up < wall.height));
        }
    return *fit;
}

DisplayFile small_desk() {
    DisplayFile file = example_displays(DisplayKind::desk);
    file.head.fixed_head.position = {0.0, 1.2, 0.5};
    file.walls.resize(1);
    file.walls[0].lower_left = {-0.48, 0.75, -0.3};
    file.walls[0].lower_right = {0.48, 0.75, -0.3};
    file.walls[0].upper_right = {0.48, 1.29, -0.3};
    return file;
}

}  // namespace

TEST_CASE("Panel on walls: it is whole on the front wall, with text of 20 dmm") {
    for (const DisplayKind kind : {DisplayKind::wall, DisplayKind::cave, DisplayKind::desk}) {
        const DisplayFile file = example_displays(kind);
        const PanelFit fit = fit_inside(file);
        CHECK(fit.wall == (kind == DisplayKind::cave ? 1U : 0U));
        CHECK(fit.text_size == doctest::Approx(comfortable_text).epsilon(0.02));
    }
    // A front wall of 2.4 m without a ceiling, and a viewer whose eyes are near its upper edge.
    DisplayFile file = with_walls({front_wall()});
    file.head.fixed_head.position.y = 2.2;
    CHECK(fit_inside(file).text_size > 18.0);
    // A viewer who looks to the right has it on the right wall.
    DisplayFile cave = example_displays(DisplayKind::cave);
    cave.head.fixed_head.orientation = rotation({0.0, to_radians(-80.0), 0.0});
    CHECK(fit_inside(cave).wall == 2);
}

TEST_CASE(
    "Panel on walls: on a small screen it is as large as the screen, and the check reports the text's size") {
    const DisplayFile file = small_desk();
    CHECK(fit_inside(file).text_size == doctest::Approx(12.2).epsilon(0.01));
    const auto found = texts(check_displays(file));
    REQUIRE(found.size() == 1);
    CHECK(has(found[0],
              "warning: wall \"screen\": the panel of menus and hints fits on it with text of 12 dmm"));
    CHECK_FALSE(fit_panel({}, file.head.fixed_head));
    DisplayFile behind = file;
    behind.head.fixed_head.position.z = -1.0;
    CHECK_FALSE(fit_panel(behind.walls, behind.head.fixed_head));
}

TEST_CASE("Display check: walls below the floor, and eyes above all walls") {
    const auto found = texts(check_displays(with_walls({moved(front_wall(), {0.0, -1.2, 0.0})})));
    REQUIRE(found.size() == 3);  // the third: the panel is far below the eyes
    CHECK(
        has(found[0], "warning: wall \"front\": its lowest corner is 1.20 m below the floor, where y is 0"));
    CHECK(has(found[1], "warning: the fixed head, 1.60 m high, is above all walls, which end at 1.20 m"));
    CHECK(has(found[1], "--eye-height"));
}
