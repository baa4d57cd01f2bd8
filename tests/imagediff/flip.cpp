#include "tools/verify/imagediff/flip.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::imagediff;

namespace {

using Colour = std::array<std::uint8_t, 3>;

Picture plain(const Colour& colour, int size = 24) {
    Picture picture{size, size, {}};
    for (int i = 0; i < size * size; ++i) picture.rgb.insert(picture.rgb.end(), colour.begin(), colour.end());
    return picture;
}

void set(Picture& picture, int x, int y, const Colour& colour) {
    std::copy(colour.begin(), colour.end(), picture.rgb.begin() + 3 * (y * picture.width + x));
}

double difference(const Picture& a, const Picture& b) { return mean(flip(a, b)); }

}  // namespace

TEST_CASE("FLIP: equal pictures have no difference, and the measure is symmetric") {
    Random random(1);
    Picture a = plain({0, 0, 0}), b = a;
    for (std::uint8_t& value : a.rgb) value = static_cast<std::uint8_t>(random.bits());
    for (std::uint8_t& value : b.rgb) value = static_cast<std::uint8_t>(random.bits());
    CHECK(difference(a, a) == 0.0);
    CHECK(difference(a, b) == doctest::Approx(difference(b, a)).epsilon(1e-6));
    CHECK(difference(a, b) > 0.2);
}

TEST_CASE("FLIP: plain pictures have the colour difference computed by hand") {
    // Green against blue is the largest that the measure knows.
    CHECK(difference(plain({0, 255, 0}), plain({0, 0, 255})) == doctest::Approx(1.0).epsilon(1e-3));
    // Black against white is 100 apart in lightness. Green (CIELAB 87.73, −86.18, 83.18) and blue
    // (32.30, 79.19, −107.86) are 203.3 apart after Hunt's effect; so 100^0.7 = 25.1 lies above the knee at
    // 0.4 · 203.3^0.7 = 16.5.
    const double largest = std::pow(203.3, 0.7), e = std::pow(100.0, 0.7);
    const double expected = 0.95 + (e - 0.4 * largest) / (0.6 * largest) * 0.05;
    CHECK(difference(plain({0, 0, 0}), plain({255, 255, 255})) == doctest::Approx(expected).epsilon(0.002));
    // A larger step of grey is a larger difference.
    double last = 0.0;
    for (int grey = 10; grey < 250; grey += 20) {
        const auto level = static_cast<std::uint8_t>(grey);
        const double now = difference(plain({0, 0, 0}), plain({level, level, level}));
        CHECK(now > last);
        last = now;
    }
}

TEST_CASE("FLIP: a single pixel and a line are found at their place") {
    const Picture grey = plain({120, 120, 120}, 48);
    Picture dot = grey;
    set(dot, 24, 24, {255, 255, 255});
    const std::vector<float> values = flip(grey, dot);
    CHECK(values[24 * 48 + 24] > 0.2F);
    CHECK(values[2 * 48 + 2] < 1e-4F);
    Picture edge = grey;
    for (int y = 0; y < 48; ++y)
        for (int x = 24; x < 48; ++x) set(edge, x, y, {135, 135, 135});
    const std::vector<float> shift = flip(grey, edge);
    CHECK(shift[24 * 48 + 24] > shift[24 * 48 + 46]);  // the edge stands out beside the step alone
}

TEST_CASE("Image difference: returns the size and number of differences; different sizes are an error") {
    Picture a = plain({10, 20, 30}, 10), b = a;
    set(b, 3, 4, {10, 27, 30});
    const auto difference = compare(a, b);
    REQUIRE(difference.has_value());
    CHECK(difference->largest == 7);
    CHECK(difference->changed == doctest::Approx(0.01));
    CHECK_FALSE(compare(a, plain({0, 0, 0}, 11)).has_value());
    CHECK_FALSE(read_png("nowhere.png").has_value());
}
