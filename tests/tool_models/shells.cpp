// Closed shells: every edge has two triangles, and volumes agree with formulas.
#include <doctest/doctest.h>

#include "game/tool_models/glyphs.hpp"
#include "support.hpp"

namespace tool_models_shells_test {

using namespace tool_models_test;

namespace {

// The area of a regular polygon of n sides with its corners at the radius r.
double polygon_area(int n, double r) { return 0.5 * n * r * r * std::sin(2.0 * pi / n); }

}  // namespace

TEST_CASE("Shells: a turned cylinder, a tube and a hexagonal prism have the volumes of their formulas") {
    const Shell cylinder = lathe_z(std::vector<ProfilePoint>{{-1.0, 3.0}, {4.0, 3.0}}, 48);
    CHECK(unpaired_edges(cylinder) == 0);
    CHECK(volume(cylinder) == doctest::Approx(5.0 * polygon_area(48, 3.0)));
    const Shell along_x = lathe_x(std::vector<ProfilePoint>{{-1.0, 3.0}, {4.0, 3.0}}, 48);
    CHECK(volume(along_x) == doctest::Approx(volume(cylinder)));
    // Up the outside and down the bore.
    const Shell tube =
        closed_lathe_z(std::vector<ProfilePoint>{{0.0, 3.0}, {5.0, 3.0}, {5.0, 2.0}, {0.0, 2.0}}, 48);
    CHECK(unpaired_edges(tube) == 0);
    CHECK(volume(tube) == doctest::Approx(5.0 * (polygon_area(48, 3.0) - polygon_area(48, 2.0))));
    const Shell prism =
        lathe_z(std::vector<ProfilePoint>{{0.0, 5.0, hexagon_radius}, {7.0, 5.0, hexagon_radius}}, 24);
    CHECK(volume(prism) == doctest::Approx(7.0 * 2.0 * std::sqrt(3.0) * 25.0));
    const Shell square =
        lathe_z(std::vector<ProfilePoint>{{0.0, 5.0, square_radius}, {7.0, 5.0, square_radius}}, 32);
    CHECK(volume(square) == doctest::Approx(700.0));
}

TEST_CASE("Shells: a plate with rounded edges and a block lie within their bounds and are closed") {
    const Shell sharp = block({-2.0, -3.0, 0.0}, {2.0, 3.0, 1.0}, 0.5, 0.0, 8);
    CHECK(unpaired_edges(sharp) == 0);
    CHECK(volume(sharp) == doctest::Approx(24.0 - (4.0 - pi) * 0.25).epsilon(1e-3));
    const Shell round = block({-2.0, -3.0, 0.0}, {2.0, 3.0, 1.0}, 0.5, 0.2, 8);
    CHECK(unpaired_edges(round) == 0);
    CHECK(volume(round) < volume(sharp));
    CHECK(volume(round) > 0.97 * volume(sharp));
    for (const Vec3& p : round.points) {
        CHECK(std::abs(p.x) < 2.0 + 1e-9);
        CHECK(std::abs(p.y) < 3.0 + 1e-9);
        CHECK((p.z > -1e-9 && p.z < 1.0 + 1e-9));
    }
}

TEST_CASE("Shells: triangles of a concave polygon cover its area once") {
    const std::vector<Vec2> comb{{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {3, 1},
                                 {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    double sum = 0.0;
    for (const auto& t : triangulate(comb)) {
        const Vec2 a = comb[t[1]] - comb[t[0]], b = comb[t[2]] - comb[t[0]];
        const double area = 0.5 * (a.x * b.y - a.y * b.x);
        CHECK(area > 0.0);
        sum += area;
    }
    CHECK(sum == doctest::Approx(11.0));
}

TEST_CASE("Shells: strokes of every character are closed and face outwards") {
    for (const char letter : std::string("0123456789CNRVm.*-")) {
        CAPTURE(letter);
        const std::vector<Shell> strokes = text_shells({&letter, 1}, 10.0, 1.6, 0.0, 0.5);
        CHECK_FALSE(strokes.empty());
        for (const Shell& stroke : strokes) {
            CHECK(unpaired_edges(stroke) == 0);
            CHECK(volume(stroke) > 0.0);
        }
    }
    CHECK(text_shells("x", 10.0, 1.6, 0.0, 0.5).empty());
}

TEST_CASE("Shells: the checks of this suite find a hole and a triangle that is turned round") {
    Shell cube = block(Vec3(-1.0), Vec3(1.0), 0.2, 0.1, 2);
    Shell hole = cube;
    hole.triangles.pop_back();
    CHECK(unpaired_edges(hole) == 3);
    std::swap(cube.triangles[0][0], cube.triangles[0][1]);
    CHECK(unpaired_edges(cube) > 0);
}

}  // namespace tool_models_shells_test
