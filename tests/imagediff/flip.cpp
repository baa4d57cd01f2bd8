// Tests of FLIP and of the comparison of two images.
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

RgbImage uniform(const Colour& colour, int size = 24) {
    RgbImage image{size, size, {}};
    for (int i = 0; i < size * size; ++i) image.rgb.insert(image.rgb.end(), colour.begin(), colour.end());
    return image;
}

void set(RgbImage& image, int x, int y, const Colour& colour) {
    std::copy(colour.begin(), colour.end(), image.rgb.begin() + 3 * (y * image.width + x));
}

double difference(const RgbImage& a, const RgbImage& b) { return mean(flip(a, b)); }

}  // namespace

TEST_CASE("FLIP: equal images have no difference, and the measure is symmetric") {
    Random random(1);
    RgbImage a = uniform({0, 0, 0}), b = a;
    for (std::uint8_t& value : a.rgb) value = static_cast<std::uint8_t>(random.bits());
    for (std::uint8_t& value : b.rgb) value = static_cast<std::uint8_t>(random.bits());
    CHECK(difference(a, a) == 0.0);
    CHECK(difference(a, b) == doctest::Approx(difference(b, a)).epsilon(1e-6));
    CHECK(difference(a, b) > 0.2);
}

TEST_CASE("FLIP: uniform images have the colour difference computed by hand") {
    // Green against blue is the largest difference of the measure.
    CHECK(difference(uniform({0, 255, 0}), uniform({0, 0, 255})) == doctest::Approx(1.0).epsilon(1e-3));
    // Black and white differ by 100 in lightness. Green (CIELAB 87.73, −86.18, 83.18) and blue (32.30, 79.19,
    // −107.86) differ by 203.3 after the Hunt effect, so 100^0.7 = 25.1 lies above the knee at 0.4 ·
    // 203.3^0.7 = 16.5.
    const double largest = std::pow(203.3, 0.7), e = std::pow(100.0, 0.7);
    const double expected = 0.95 + (e - 0.4 * largest) / (0.6 * largest) * 0.05;
    CHECK(difference(uniform({0, 0, 0}), uniform({255, 255, 255})) ==
          doctest::Approx(expected).epsilon(0.002));
    // A larger step of grey is a larger difference.
    double last = 0.0;
    for (int grey = 10; grey < 250; grey += 20) {
        const auto level = static_cast<std::uint8_t>(grey);
        const double now = difference(uniform({0, 0, 0}), uniform({level, level, level}));
        CHECK(now > last);
        last = now;
    }
}

TEST_CASE("FLIP: a single changed pixel and a changed edge raise the value where they are") {
    const RgbImage grey = uniform({120, 120, 120}, 48);
    RgbImage dot = grey;
    set(dot, 24, 24, {255, 255, 255});
    const std::vector<float> values = flip(grey, dot);
    CHECK(values[24 * 48 + 24] > 0.2F);
    CHECK(values[2 * 48 + 2] < 1e-4F);
    RgbImage edge = grey;
    for (int y = 0; y < 48; ++y)
        for (int x = 24; x < 48; ++x) set(edge, x, y, {135, 135, 135});
    const std::vector<float> shift = flip(grey, edge);
    CHECK(shift[24 * 48 + 24] > shift[24 * 48 + 46]);  // more at the edge than inside the step
}

TEST_CASE(
    "Image difference: compare() returns the size and number of differences and rejects different sizes") {
    RgbImage a = uniform({10, 20, 30}, 10), b = a;
    set(b, 3, 4, {10, 27, 30});
    const auto difference = compare(a, b);
    REQUIRE(difference.has_value());
    CHECK(difference->largest == 7);
    CHECK(difference->changed == doctest::Approx(0.01));
    CHECK_FALSE(compare(a, uniform({0, 0, 0}, 11)).has_value());
    CHECK_FALSE(read_png("nowhere.png").has_value());
}
