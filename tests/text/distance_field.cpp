#include "engine/text/atlas.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <numbers>

using namespace bolt;
using namespace bolt::text;

namespace {

std::vector<glm::dvec2> circle(glm::dvec2 middle, double radius, int corners = 2000) {
    std::vector<glm::dvec2> ring;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / corners;
        ring.push_back(middle + radius * glm::dvec2(std::cos(angle), std::sin(angle)));
    }
    return ring;
}

std::vector<glm::dvec2> box(glm::dvec2 low, glm::dvec2 high) {
    return {low, {high.x, low.y}, high, {low.x, high.y}};
}

double box_distance(glm::dvec2 p, glm::dvec2 low, glm::dvec2 high) {
    const glm::dvec2 beyond = glm::abs(p - 0.5 * (low + high)) - 0.5 * (high - low);
    return -glm::length(glm::max(beyond, 0.0)) - std::min(std::max(beyond.x, beyond.y), 0.0);
}

// Returns the largest deviation from the exact distance.
template <class Exact>
double worst(const DistanceField& field, double texels_per_em, double reach, const Exact& exact) {
    double largest = 0.0;
    for (int y = 0; y < field.height; ++y)
        for (int x = 0; x < field.width; ++x) {
            const glm::dvec2 p = field.low + glm::dvec2(x + 0.5, y + 0.5) / texels_per_em;
            const auto made =
                static_cast<double>(field.distances[static_cast<std::size_t>(y * field.width + x)]);
            largest = std::max(largest, std::abs(made - std::clamp(exact(p), -reach, reach)));
        }
    return largest;
}

}  // namespace

TEST_CASE("Distance field: exact for a circle, a ring and a box") {
    const glm::dvec2 middle(0.31, 0.42);
    const auto of_circle = [&](glm::dvec2 p) { return 0.3 - glm::distance(p, middle); };
    const DistanceField disc = distance_field({circle(middle, 0.3)}, 64.0, 0.125);
    CHECK(disc.width == doctest::Approx((0.6 + 0.25) * 64.0).epsilon(0.04));
    CHECK(worst(disc, 64.0, 0.125, of_circle) < 2e-6);

    std::vector<glm::dvec2> hole = circle(middle, 0.15);
    std::reverse(hole.begin(), hole.end());
    const DistanceField ring = distance_field({circle(middle, 0.3), hole}, 64.0, 0.1);
    CHECK(worst(ring, 64.0, 0.1, [&](glm::dvec2 p) {
              return std::min(of_circle(p), glm::distance(p, middle) - 0.15);
          }) < 2e-6);

    const DistanceField square = distance_field({box({0, 0}, {0.5, 0.7})}, 48.0, 0.1);
    CHECK(worst(square, 48.0, 0.1, [](glm::dvec2 p) { return box_distance(p, {0, 0}, {0.5, 0.7}); }) < 2e-6);
    // Negative control: a box that is 0.01 lower is detected.
    CHECK(worst(square, 48.0, 0.1, [](glm::dvec2 p) {
              return box_distance(p, {0, 0}, {0.5, 0.69});
          }) > 0.009);
    CHECK(distance_field({}, 64.0, 0.1).distances.empty());
    CHECK(distance_field({{{0.1, 0.1}, {0.1, 0.1}}}, 64.0, 0.1).distances.empty());
}

TEST_CASE("Distance field: overlapping strokes have no edge inside") {
    // A cross of two bars, as drawn in Chinese fonts.
    const glm::dvec2 a0(0.0, 0.4), a1(1.0, 0.6), b0(0.4, 0.0), b1(0.6, 1.0);
    const DistanceField cross = distance_field({box(a0, a1), box(b0, b1)}, 64.0, 0.12);
    // Returns the signed distance to the union, or -1 where it is not compared. Inside, the nearest edge is
    // that of a bar where the other bar does not cover it.
    const auto exact = [&](glm::dvec2 p) {
        const double a = box_distance(p, a0, a1), b = box_distance(p, b0, b1);
        if (a < 0.0 && b < 0.0) return std::max(a, b);
        if (a < 0.0 || b < 0.0) {  // in one bar only: its edges, up to the start of the other bar
            const double inside = std::max(a, b), to_other = -std::min(a, b);
            return to_other > 0.11 ? inside : -1.0;
        }
        // In both bars: the nearest of the four corners where they meet.
        double nearest = 1.0;
        for (const double x : {0.4, 0.6})
            for (const double y : {0.4, 0.6}) nearest = std::min(nearest, glm::distance(p, {x, y}));
        return nearest;
    };
    double largest = 0.0;
    int compared = 0;
    for (int y = 0; y < cross.height; ++y)
        for (int x = 0; x < cross.width; ++x) {
            const glm::dvec2 p = cross.low + glm::dvec2(x + 0.5, y + 0.5) / 64.0;
            const double wanted = exact(p);
            if (wanted == -1.0) continue;
            ++compared;
            const auto made =
                static_cast<double>(cross.distances[static_cast<std::size_t>(y * cross.width + x)]);
            largest = std::max(largest, std::abs(made - std::clamp(wanted, -0.12, 0.12)));
        }
    CHECK(compared > 2000);
    CHECK(largest < 1.0 / 64.0);  // pieces of an edge are one texel long
}

TEST_CASE("Atlas: glyphs do not overlap, changed rows are reported, and a full atlas is an error") {
    const Result<Fonts> fonts = load_fonts();
    REQUIRE(fonts.has_value());
    Atlas atlas(256);
    CHECK(atlas.take_changed_rows().count == 256);  // at first all rows
    CHECK(atlas.take_changed_rows().count == 0);
    std::vector<AtlasGlyph> made;
    const AtlasGlyph* space = atlas.glyph(*fonts, find_glyph(*fonts, U' '));
    REQUIRE(space != nullptr);
    CHECK(space->low == space->high);
    CHECK(atlas.take_changed_rows().count == 0);
    char32_t point = U'A';
    for (;; ++point) {
        const AtlasGlyph* glyph = atlas.glyph(*fonts, find_glyph(*fonts, point));
        if (glyph == nullptr) break;
        made.push_back(*glyph);
        REQUIRE(point < U'z');
    }
    CHECK(made.size() > 8);
    const Atlas::RowRange rows = atlas.take_changed_rows();
    CHECK(rows.first == 0);
    CHECK(rows.count <= 256);
    CHECK(rows.count > 128);
    for (std::size_t i = 0; i < made.size(); ++i) {
        CHECK(glm::all(glm::greaterThan(made[i].uv_low, glm::vec2(0.0F))));
        CHECK(glm::all(glm::lessThan(made[i].uv_high, glm::vec2(1.0F))));
        for (std::size_t k = 0; k < i; ++k) {
            const bool apart = made[i].uv_low.x > made[k].uv_high.x || made[k].uv_low.x > made[i].uv_high.x ||
                               made[i].uv_low.y > made[k].uv_high.y || made[k].uv_low.y > made[i].uv_high.y;
            CHECK(apart);
        }
    }
    REQUIRE(atlas.glyph(*fonts, find_glyph(*fonts, U'A')) != nullptr);  // existing glyphs stay
    CHECK(atlas.glyph(*fonts, find_glyph(*fonts, U'A'))->uv_low == made.front().uv_low);
}
