// The geometry of walls against closed forms.
#include <doctest/doctest.h>

#include <cmath>

#include "content/displays/example_displays.hpp"
#include "content/displays/test_pattern.hpp"
#include "content/displays/wall_geometry.hpp"
#include "content/displays/wall_summary.hpp"
#include "engine/base/random.hpp"
#include "engine/render/camera.hpp"
#include "tests/displays/support.hpp"

namespace wall_geometry_test {

using namespace bolt;
using namespace bolt::content;
using namespace displays_test;

namespace {

constexpr float near_plane = 0.1F, far_plane = 100.0F;

render::Eye eye_of(const Wall& wall, const Vec3& eye) {
    return render::make_wall_eye(glm::vec3(eye), glm::vec3(wall.lower_left), glm::vec3(wall.lower_right),
                                 glm::vec3(upper_left(wall)), near_plane, far_plane);
}

// x and y from -1 to 1, y up.
glm::dvec2 projected(const render::Eye& eye, const Vec3& point) {
    const glm::dvec4 clip = glm::dmat4(eye.clip_from_world) * glm::dvec4(point, 1.0);
    return {clip.x / clip.w, -clip.y / clip.w};
}

Wall random_wall(Random& random) {
    const auto any = [&] { return 2.0 * random.uniform() - 1.0; };
    const Quat turn = rotation(Vec3(any(), any(), any()) * 2.0);
    Wall wall;
    wall.name = "random";
    wall.lower_left = Vec3(any(), any(), any()) * 3.0;
    wall.lower_right = wall.lower_left + turn * Vec3(0.5 + random.uniform() * 4.0, 0.0, 0.0);
    wall.upper_right = wall.lower_right + turn * Vec3(0.0, 0.5 + random.uniform() * 3.0, 0.0);
    return wall;
}

}  // namespace

TEST_CASE("Wall: its axes give the corners, and a normal towards the viewer") {
    const WallAxes axes = axes_of(front_wall());
    CHECK(axes.right == Vec3(1, 0, 0));
    CHECK(axes.up == Vec3(0, 1, 0));
    CHECK(axes.normal == Vec3(0, 0, 1));
    CHECK(axes.width == 3.0);
    CHECK(axes.height == 2.4);
    CHECK(distance_in_front(axes, {0.0, 1.6, 0.0}) == 1.5);
    CHECK(distance_in_front(axes, {0.0, 1.6, -2.0}) == -0.5);
    CHECK(upper_left(front_wall()) == Vec3(-1.5, 2.4, -1.5));
    const auto corners = corners_of(axes, 0.1);
    CHECK(glm::length(corners[2] - Vec3(1.4, 2.3, -1.5)) < 1e-12);
    for (const Wall& wall : example_displays(DisplayKind::cave).walls)  // of a box that the viewer stands in
        CHECK(distance_in_front(axes_of(wall), {0.0, 1.2, 0.0}) > 1.0);
}

TEST_CASE(
    "Wall: the frustum of an eye in front of its middle is symmetric, and the angles are those of the wall") {
    const render::Eye eye = eye_of(front_wall(), {0.0, 1.2, 0.0});  // 1.5 m away, half the width is 1.5 m
    // A point at 45 degrees to the right is at the right edge; in the direction of the middle it is at the
    // middle.
    CHECK(projected(eye, {0.75, 1.2, -0.75}).x == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(projected(eye, {-4.0, 1.2, -4.0}).x == doctest::Approx(-1.0).epsilon(1e-5));
    CHECK(std::abs(projected(eye, {0.0, 1.2, -0.3}).x) < 1e-5);
    CHECK(projected(eye, {0.0, 2.4, -1.5}).y == doctest::Approx(1.0).epsilon(1e-5));
    CHECK(projected(eye, {0.0, 0.0, -1.5}).y == doctest::Approx(-1.0).epsilon(1e-5));
}

TEST_CASE("Wall: the frustum of an eye beside the wall is off its axis by the similar triangles") {
    // 2 m to the right of the middle and 1 m away: the edges are at -3.5 m and -0.5 m, so the point straight
    // ahead of the eye is outside, at (0 + 2) / 1.5 of half the width.
    const render::Eye eye = eye_of(front_wall(), {2.0, 1.2, -0.5});
    CHECK(projected(eye, {2.0, 1.2, -3.0}).x == doctest::Approx(2.0 / 1.5).epsilon(1e-5));
    CHECK(projected(eye, {2.0 - 3.5, 1.2, -1.5}).x == doctest::Approx(-1.0).epsilon(1e-5));
    // Behind the wall by as much as the eye is in front: a point 7 m to the left of the eye is at the left
    // edge.
    CHECK(projected(eye, {2.0 - 7.0, 1.2, -2.5}).x == doctest::Approx(-1.0).epsilon(1e-5));
}

TEST_CASE("Wall: its corners are projected to the corners of the picture from anywhere in front") {
    Random random(11);
    for (int i = 0; i < 200; ++i) {
        const Wall wall = random_wall(random);
        const WallAxes axes = axes_of(wall);
        const Vec3 position = in_room(axes, (2.0 * random.uniform() - 0.5) * axes.width,
                                      (2.0 * random.uniform() - 0.5) * axes.height) +
                              axes.normal * (0.3 + 3.0 * random.uniform());
        const render::Eye eye = eye_of(wall, position);
        const auto corners = corners_of(axes);
        const glm::dvec2 expected[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
        for (std::size_t k = 0; k < 4; ++k) {
            const glm::dvec2 at = projected(eye, corners[k]);
            CHECK(at.x == doctest::Approx(expected[k].x).epsilon(2e-4));
            CHECK(at.y == doctest::Approx(expected[k].y).epsilon(2e-4));
        }
    }
}

TEST_CASE("Wall: a point in the wall has no parallax, and one behind it moves with the eye") {
    const Wall wall = front_wall();
    const render::Eye left = eye_of(wall, {-0.03, 1.6, 0.0}), right = eye_of(wall, {0.03, 1.6, 0.0});
    const Vec3 on_wall(0.4, 1.0, -1.5), behind(0.4, 1.0, -3.0);
    CHECK(glm::length(projected(left, on_wall) - projected(right, on_wall)) < 1e-5);
    // Twice as far as the wall: half the distance of the eyes, 0.03 m, of 1.5 m.
    CHECK(projected(right, behind).x - projected(left, behind).x ==
          doctest::Approx(0.03 / 1.5).epsilon(1e-3));
}

TEST_CASE("Wall: walls cross exactly if a common line is inside both") {
    const WallAxes front = axes_of(front_wall());
    CHECK(
        walls_cross(front, axes_of(moved(turned_wall("t", 90.0), {1.5, 0.0, -1.5})), 0.01));  // same heights
    CHECK(walls_cross(front, axes_of(moved(turned_wall("t", 45.0), {1.0, -1.0, 0.0})), 0.01));
    // Left and front of a cave meet at an edge; one that extends 5 mm too far still does, 20 mm cross.
    const WallAxes left = axes_of(turned_wall("left", 90.0));
    CHECK_FALSE(walls_cross(front, left, 0.01));
    CHECK_FALSE(walls_cross(front, axes_of(moved(turned_wall("left", 90.0), {0.005, 0.0, -0.005})), 0.01));
    CHECK(walls_cross(front, axes_of(moved(turned_wall("left", 90.0), {0.02, 0.0, -0.02})), 0.01));
    CHECK_FALSE(walls_cross(front, axes_of(moved(front_wall(), {0.1, 0.1, 0.0})), 0.01));   // one plane
    CHECK_FALSE(walls_cross(front, axes_of(moved(front_wall(), {0.1, 0.1, -0.5})), 0.01));  // parallel
    // The planes meet inside one wall and beside the other.
    CHECK_FALSE(walls_cross(front, axes_of(moved(turned_wall("t", 90.0), {1.5, 3.0, -1.5})), 0.01));
    CHECK_FALSE(walls_cross(front, axes_of(moved(turned_wall("t", 90.0), {1.5, 0.0, 2.0})), 0.01));
    Random random(3);
    int crossings = 0;
    for (int i = 0; i < 300; ++i) {  // symmetric; and walls through one point that is inside both do cross
        const WallAxes a = axes_of(random_wall(random)), b = axes_of(random_wall(random));
        CHECK(walls_cross(a, b, 0.01) == walls_cross(b, a, 0.01));
        crossings += walls_cross(a, b, 0.01) ? 1 : 0;
        Wall through = random_wall(random);
        const WallAxes own = axes_of(through);
        const Vec3 to =
            in_room(a, 0.5 * a.width, 0.5 * a.height) - in_room(own, 0.5 * own.width, 0.5 * own.height);
        CHECK(walls_cross(a, axes_of(moved(through, to)), 0.01));
    }
    CHECK(crossings > 10);
    CHECK(crossings < 290);
}

TEST_CASE("Wall: a wall that ends inside another one is found, with its distance from the edge") {
    const WallAxes front = axes_of(front_wall()), left = axes_of(turned_wall("left", 90.0));
    CHECK_FALSE(edge_inset(left, front, 0.01));  // they meet at their edges
    CHECK_FALSE(edge_inset(front, left, 0.01));
    const WallAxes inner = axes_of(moved(turned_wall("left", 90.0), {0.2, 0.0, 0.0}));
    CHECK(edge_inset(inner, front, 0.01).value_or(0.0) == doctest::Approx(0.2));
    CHECK_FALSE(edge_inset(front, inner, 0.01));
    CHECK_FALSE(walls_cross(inner, front, 0.01));
    // Beside the other wall, above it, and not on its plane.
    CHECK_FALSE(edge_inset(axes_of(moved(turned_wall("left", 90.0), {-0.2, 0.0, 0.0})), front, 0.01));
    CHECK_FALSE(edge_inset(axes_of(moved(turned_wall("left", 90.0), {0.2, 2.4, 0.0})), front, 0.01));
    CHECK_FALSE(edge_inset(axes_of(moved(turned_wall("left", 90.0), {0.2, 0.0, 0.1})), front, 0.01));
    CHECK_FALSE(edge_inset(axes_of(moved(front_wall(), {0.2, 0.0, 0.0})), front, 0.01));  // one plane
}

TEST_CASE("Wall: overlaps in one plane and gaps of seams are measured") {
    const WallAxes front = axes_of(front_wall());
    CHECK_FALSE(coplanar_overlap(front, axes_of(moved(front_wall(), {3.0, 0.0, 0.0})), 0.01));
    CHECK(coplanar_overlap(front, axes_of(moved(front_wall(), {2.8, 0.0, 0.0})), 0.01).value_or(0.0) ==
          doctest::Approx(0.2));
    CHECK_FALSE(coplanar_overlap(front, axes_of(moved(front_wall(), {2.8, 0.0, 0.1})), 0.01));
    CHECK_FALSE(coplanar_overlap(front, axes_of(turned_wall("left", 90.0)), 0.01));
    CHECK(seam_gap(front, axes_of(moved(front_wall(), {3.0, 0.0, 0.0}))).value_or(1.0) < 1e-12);
    CHECK(seam_gap(front, axes_of(moved(front_wall(), {3.004, 0.0, 0.003}))).value_or(0.0) ==
          doctest::Approx(0.005));
    CHECK(seam_gap(front, axes_of(turned_wall("left", 90.0))).value_or(1.0) < 1e-12);
    // Edges that are not parallel are no seam.
    Wall rolled = moved(front_wall(), {3.0, 0.0, 0.0});
    const Quat roll = rotation(Vec3(0.0, 0.0, 0.3));
    for (Vec3* corner : {&rolled.lower_left, &rolled.lower_right, &rolled.upper_right})
        *corner = roll * *corner;
    CHECK_FALSE(seam_gap(front, axes_of(rolled)));
    CHECK_FALSE(seam_gap(front, axes_of(Wall{})));
}

TEST_CASE("Wall: the summary has sizes of pixels, angles of the wall, and the angle that it covers") {
    Wall left = turned_wall("left", 90.0);
    WallSummary s = summarize(left, {0.0, 1.2, 0.0}, left.output.resolution);
    CHECK(s.turn == doctest::Approx(pi / 2));
    CHECK(std::abs(s.tilt) < 1e-12);
    CHECK(s.distance == doctest::Approx(1.5));
    CHECK(s.seen_width == doctest::Approx(pi / 2));
    CHECK(s.seen_height == doctest::Approx(2.0 * std::atan(1.2 / 1.5)));
    CHECK(s.pixel_width == doctest::Approx(0.002));
    CHECK(s.pixel_height == doctest::Approx(0.002));
    left.stereo = StereoMode::side_by_side;
    s = summarize(left, {0.0, 1.2, 0.0}, left.output.resolution);
    CHECK(s.resolution == PixelSize{750, 1200});
    CHECK(s.pixel_width == doctest::Approx(0.004));
    left.stereo = StereoMode::top_bottom;
    CHECK(summarize(left, {0.0, 1.2, 0.0}, left.output.resolution).resolution == PixelSize{1500, 600});
    CHECK_FALSE(summarize(left, {0.0, 1.2, 0.0}, {}).resolution);
    const DisplayFile cave = example_displays(DisplayKind::cave);
    CHECK(summarize(cave.walls[3], {0.0, 1.6, 0.0}, {}).tilt == doctest::Approx(pi / 2));   // floor
    CHECK(summarize(cave.walls[4], {0.0, 1.6, 0.0}, {}).tilt == doctest::Approx(-pi / 2));  // ceiling
    const std::string list = list_walls(cave);
    CHECK_MESSAGE(has(list, "left and front meet at 90.0 degrees, gap 0.0 mm"), list);
    CHECK(has(list, "DTrack on UDP port 5000, body 0"));
    CHECK(has(list, "1500x1200+3000+0"));
}

TEST_CASE("Test pattern: the scales have their length on the wall, and the border is its edge") {
    for (const Wall& wall :
         {front_wall(), turned_wall("t", 33.0), example_displays(DisplayKind::desk).walls[1]}) {
        const TestPattern pattern = test_pattern(wall, PatternEye::both);
        const auto corners = corners_of(axes_of(wall));
        int scales = 0, borders = 0;
        for (const PatternLine& line : pattern.lines) {
            const Vec3 from = pattern_point(wall, line.from), to = pattern_point(wall, line.to);
            CHECK(std::abs(glm::length(to - from) - glm::length(line.to - line.from)) < 1e-12);
            for (const glm::dvec2& end : {line.from, line.to}) {  // all lines are on the wall
                CHECK(end.x >= 0.0);
                CHECK(end.x <= width(wall));
                CHECK(end.y >= 0.0);
                CHECK(end.y <= height(wall));
            }
            if (line.part == PatternPart::border)
                CHECK(glm::length(from - corners[static_cast<std::size_t>(borders++)]) < 1e-12);
            if (line.part == PatternPart::scale &&
                std::abs(glm::length(to - from) - pattern.scale_length) < 1e-12)
                ++scales;
        }
        CHECK(borders == 4);
        CHECK(scales == 2);  // one horizontal, one vertical
    }
    CHECK(test_pattern(front_wall(), PatternEye::both).scale_length == 0.5);
    CHECK(test_pattern(example_displays(DisplayKind::desk).walls[0], PatternEye::both).scale_length == 0.2);
    CHECK(test_pattern(Wall{}, PatternEye::both).lines.empty());
}

TEST_CASE("Test pattern: texts name the wall, the length, the eye and the frame") {
    const auto words = [](PatternEye eye, std::uint64_t frame) {
        std::string all;
        for (const PatternText& text : test_pattern(front_wall(), eye, frame).texts) all += text.text + "|";
        return all;
    };
    CHECK(words(PatternEye::both, 0) == "front|0.5 m|frame 0|");
    CHECK(words(PatternEye::left, 4711) == "front|0.5 m|frame 4711|left|");
    CHECK(words(PatternEye::right, 1) == "front|0.5 m|frame 1|right|");
    // The mark of the frame moves on by one and returns after ten frames.
    const auto mark = [](std::uint64_t frame) {
        double at = -1.0;
        int present = 0, others = 0;
        for (const PatternLine& line : test_pattern(front_wall(), PatternEye::both, frame).lines) {
            if (line.part == PatternPart::present_mark) at = line.from.x, ++present;
            if (line.part == PatternPart::frame_marks) ++others;
        }
        CHECK(present == 1);
        CHECK(others == frame_mark_count - 1);
        return at;
    };
    const double step = mark(1) - mark(0);
    CHECK(step > 0.01);
    CHECK(mark(9) - mark(8) == doctest::Approx(step));
    CHECK(mark(10) == mark(0));
    CHECK(mark(18446744073709551615U) == mark(5));
}

}  // namespace wall_geometry_test
