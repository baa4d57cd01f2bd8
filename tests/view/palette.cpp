// The colours of the palettes are distinguishable without red or green cones.
#include "game/view/labels.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <set>
#include <string>

using namespace bolt;
using namespace bolt::view;

namespace {

// Machado, Oliveira and Fernandes, A physiologically-based model for simulation of color vision deficiency,
// IEEE TVCG 15 (2009), table 1, severity 1: linear RGB in, linear RGB out. Columns as GLM has them.
const glm::dmat3 all_cones(1.0);
const glm::dmat3 no_red(0.152286, 0.114503, -0.003882, 1.052583, 0.786281, -0.048116, -0.204868, 0.099216,
                        1.051998);
const glm::dmat3 no_green(0.367322, 0.280085, -0.011820, 0.860646, 0.672501, 0.042940, -0.227968, 0.047413,
                          0.968881);

double linear(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }

// CIE 1976 L*a*b*, white D65.
glm::dvec3 lab(const glm::dvec3& rgb) {
    const glm::dmat3 xyz(0.4124, 0.2126, 0.0193, 0.3576, 0.7152, 0.1192, 0.1805, 0.0722, 0.9505);
    const glm::dvec3 t = xyz * rgb / glm::dvec3(0.9505, 1.0, 1.089);
    const auto f = [](double v) { return v > 0.008856 ? std::cbrt(v) : 7.787 * v + 16.0 / 116.0; };
    return {116.0 * f(t.y) - 16.0, 500.0 * (f(t.x) - f(t.y)), 200.0 * (f(t.y) - f(t.z))};
}

glm::dvec3 perceived(const glm::vec4& color, const glm::dmat3& eyes) {
    const glm::dvec3 c(color);
    return lab(glm::clamp(eyes * glm::dvec3(linear(c.r), linear(c.g), linear(c.b)), 0.0, 1.0));
}

// The least CIE 1976 difference between two colours of different meaning.
double min_difference(const Palette& p, const glm::dmat3& eyes) {
    const std::array colors{p.due, p.low, p.ok, p.high};
    double least = glm::distance(perceived(p.ok_text, eyes), perceived(p.high_text, eyes));
    for (std::size_t i = 0; i < colors.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            least = std::min(least, glm::distance(perceived(colors[i], eyes), perceived(colors[j], eyes)));
    return least;
}

}  // namespace

TEST_CASE(
    "Palette: the distinct palette is distinguishable without red or green cones, the usual one is not") {
    const Palette distinct = palette_of(content::PaletteKind::distinct);
    const Palette usual = palette_of(content::PaletteKind::usual);
    for (const glm::dmat3& eyes : {all_cones, no_red, no_green}) CHECK(min_difference(distinct, eyes) > 25.0);
    CHECK(min_difference(usual, no_red) < 20.0);
    CHECK(min_difference(usual, no_green) < 20.0);
}

TEST_CASE("Palette: each verdict has its own symbol") {
    using lesson::Verdict;
    std::set<std::string> symbols{std::string(due_symbol)};
    for (const Verdict verdict : {Verdict::low, Verdict::ok, Verdict::high}) {
        CHECK_FALSE(symbol_of(verdict).empty());
        CHECK(symbols.insert(std::string(symbol_of(verdict))).second);
        CHECK(color_of(palette_of(content::PaletteKind::usual), verdict).w == 1.0F);
    }
    CHECK(symbol_of(Verdict::none).empty());
    CHECK(color_of({}, Verdict::none).w == 0.0F);
    lesson::JointResult broken;
    broken.overall = Verdict::ok;
    broken.condition = joint::JointCondition::broken;
    CHECK(verdict_of(broken) == Verdict::high);
}
