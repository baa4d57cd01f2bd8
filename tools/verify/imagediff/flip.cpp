#include "tools/verify/imagediff/flip.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>
#include <numbers>

#include "engine/assets/image.hpp"
#include "engine/base/file.hpp"

namespace bolt::imagediff {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

// From linear sRGB (D65) to XYZ. The white point is the sum of the columns.
const glm::mat3 xyz_from_rgb(0.4124564F, 0.2126729F, 0.0193339F, 0.3575761F, 0.7151522F, 0.1191920F,
                             0.1804375F, 0.0721750F, 0.9503041F);
const glm::vec3 white = xyz_from_rgb * glm::vec3(1.0F);

float linear(std::uint8_t encoded) {
    const float x = static_cast<float>(encoded) / 255.0F;
    return x <= 0.04045F ? x / 12.92F : std::pow((x + 0.055F) / 1.055F, 2.4F);
}

// Returns the colour in the opponent space in which the eye's contrast sensitivity is modelled: the axes of
// CIELAB without its nonlinearity.
glm::vec3 opponent(const glm::vec3& rgb) {
    const glm::vec3 n = xyz_from_rgb * rgb / white;
    return {116.0F * n.y - 16.0F, 500.0F * (n.x - n.y), 200.0F * (n.y - n.z)};
}

glm::vec3 rgb_of_opponent(const glm::vec3& c) {
    const float y = (c.x + 16.0F) / 116.0F;
    return glm::inverse(xyz_from_rgb) * (glm::vec3(y + c.y / 500.0F, y, y - c.z / 200.0F) * white);
}

// Returns CIELAB with the Hunt effect: dark colours look less colourful.
glm::vec3 hunt_lab(const glm::vec3& rgb) {
    const glm::vec3 n = xyz_from_rgb * rgb / white;
    const auto f = [](float t) {
        constexpr float d = 6.0F / 29.0F;
        return t > d * d * d ? std::cbrt(t) : t / (3.0F * d * d) + 4.0F / 29.0F;
    };
    const float l = 116.0F * f(n.y) - 16.0F;
    return {l, 0.01F * l * 500.0F * (f(n.x) - f(n.y)), 0.01F * l * 200.0F * (f(n.y) - f(n.z))};
}

float hyab(const glm::vec3& a, const glm::vec3& b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

using Kernel = std::vector<float>;  // odd length; the origin is the middle element

// One channel of an image.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;

    [[nodiscard]] float at(int x, int y) const {
        return values[static_cast<std::size_t>(std::clamp(y, 0, height - 1)) *
                          static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(std::clamp(x, 0, width - 1))];
    }
};

// Convolves the plane with one kernel in x and another in y. Border pixels repeat.
Plane convolve(const Plane& plane, const Kernel& kernel_x, const Kernel& kernel_y) {
    const auto pass = [](const Plane& from, const Kernel& kernel, int dx, int dy) {
        Plane to{from.width, from.height, {}};
        to.values.reserve(from.values.size());
        const int radius = static_cast<int>(kernel.size() / 2);
        for (int y = 0; y < from.height; ++y) {
            for (int x = 0; x < from.width; ++x) {
                float sum = 0.0F;
                for (int k = -radius; k <= radius; ++k)
                    sum += kernel[static_cast<std::size_t>(k + radius)] * from.at(x + k * dx, y + k * dy);
                to.values.push_back(sum);
            }
        }
        return to;
    };
    return pass(pass(plane, kernel_x, 1, 0), kernel_y, 0, 1);
}

Kernel gaussian(float b, int radius, float pixels_per_degree) {
    Kernel kernel;
    float sum = 0.0F;
    for (int k = -radius; k <= radius; ++k) {
        const float x = static_cast<float>(k) / pixels_per_degree;
        kernel.push_back(std::exp(-pi * pi * x * x / b));
        sum += kernel.back();
    }
    for (float& value : kernel) value /= sum;
    return kernel;
}

// The contrast sensitivity of one channel: a sum of Gaussians a √(π/b) e^{−π² x²/b}, normalised so that
// uniform grey does not change.
struct Sensitivity {
    float a1, b1, a2, b2;
};
constexpr Sensitivity sensitivities[] = {{1.0F, 0.0047F, 0.0F, 1e-5F},    // light
                                         {1.0F, 0.0053F, 0.0F, 1e-5F},    // red to green
                                         {34.1F, 0.04F, 13.5F, 0.025F}};  // blue to yellow

Plane filter_contrast(const Plane& plane, const Sensitivity& s, float pixels_per_degree) {
    const float widest = std::max(s.b1, s.a2 > 0.0F ? s.b2 : 0.0F);
    const int radius =
        static_cast<int>(std::ceil(3.0F * std::sqrt(widest / (2.0F * pi * pi)) * pixels_per_degree));
    const Kernel first = gaussian(s.b1, radius, pixels_per_degree);
    Plane sum = convolve(plane, first, first);
    if (s.a2 <= 0.0F) return sum;
    // A Gaussian e^{−π² x²/b} integrates to b/π over the plane, so the term a √(π/b) has the weight a √(b/π).
    const Kernel second = gaussian(s.b2, radius, pixels_per_degree);
    const Plane other = convolve(plane, second, second);
    const float weight = s.a1 * std::sqrt(s.b1), share = weight / (weight + s.a2 * std::sqrt(s.b2));
    for (std::size_t i = 0; i < sum.values.size(); ++i)
        sum.values[i] = share * sum.values[i] + (1.0F - share) * other.values[i];
    return sum;
}

struct Planes {
    Plane channels[3];
};

Planes opponent_planes(const RgbImage& image) {
    Planes planes;
    for (Plane& plane : planes.channels) plane = {image.width, image.height, {}};
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3) {
        const glm::vec3 c =
            opponent({linear(image.rgb[i]), linear(image.rgb[i + 1]), linear(image.rgb[i + 2])});
        for (int k = 0; k < 3; ++k) planes.channels[k].values.push_back(c[k]);
    }
    return planes;
}

// Returns the pixels as the eye sees them at this resolution, in Hunt-adjusted CIELAB.
std::vector<glm::vec3> perceived(const Planes& planes, float pixels_per_degree) {
    Plane blurred[3];
    for (int k = 0; k < 3; ++k)
        blurred[k] = filter_contrast(planes.channels[k], sensitivities[k], pixels_per_degree);
    std::vector<glm::vec3> lab;
    lab.reserve(blurred[0].values.size());
    for (std::size_t i = 0; i < blurred[0].values.size(); ++i) {
        const glm::vec3 c(blurred[0].values[i], blurred[1].values[i], blurred[2].values[i]);
        lab.push_back(hunt_lab(glm::clamp(rgb_of_opponent(c), 0.0F, 1.0F)));
    }
    return lab;
}

// Maps a HyAB distance to 0 … 1, where 1 is the distance between green and blue. Small differences get more
// than their proportional value.
float colour_difference(const glm::vec3& a, const glm::vec3& b) {
    constexpr float exponent = 0.7F, knee = 0.4F, at_knee = 0.95F;
    static const float largest = std::pow(hyab(hunt_lab({0, 1, 0}), hunt_lab({0, 0, 1})), exponent);
    const float e = std::pow(hyab(a, b), exponent);
    const float limit = knee * largest;
    const float value =
        e < limit ? at_knee / limit * e : at_knee + (e - limit) / (largest - limit) * (1.0F - at_knee);
    return std::min(value, 1.0F);
}

struct FeatureMaps {
    Plane edge_x, edge_y, point_x, point_y;
};

// Filters the lightness with the first (edges) and second (points) derivatives of a Gaussian as wide as the
// finest detail that the eye notices. The positive and the negative part of each kernel sum to ±1.
FeatureMaps features(const Plane& light, float pixels_per_degree) {
    const float sigma = 0.5F * 0.082F * pixels_per_degree;
    const int radius = static_cast<int>(std::ceil(3.0F * sigma));
    Kernel smooth, first, second;
    for (int k = -radius; k <= radius; ++k) {
        const float x = static_cast<float>(k);
        const float g = std::exp(-x * x / (2.0F * sigma * sigma));
        smooth.push_back(g);
        first.push_back(-x * g);
        second.push_back((x * x / (sigma * sigma) - 1.0F) * g);
    }
    const auto balance = [](Kernel& kernel) {
        float up = 0.0F, down = 0.0F;
        for (const float value : kernel) (value > 0.0F ? up : down) += value;
        for (float& value : kernel) value /= value > 0.0F ? up : down != 0.0F ? -down : 1.0F;
    };
    for (Kernel* kernel : {&smooth, &first, &second}) balance(*kernel);
    return {convolve(light, first, smooth), convolve(light, smooth, first), convolve(light, second, smooth),
            convolve(light, smooth, second)};
}

Plane lightness(const Plane& achromatic) {
    Plane plane = achromatic;
    for (float& value : plane.values) value = (value + 16.0F) / 116.0F;
    return plane;
}

}  // namespace

std::vector<float> flip(const RgbImage& reference, const RgbImage& test, float pixels_per_degree) {
    const Planes a = opponent_planes(reference), b = opponent_planes(test);
    const std::vector<glm::vec3> perceived_a = perceived(a, pixels_per_degree),
                                 perceived_b = perceived(b, pixels_per_degree);
    const FeatureMaps fa = features(lightness(a.channels[0]), pixels_per_degree);
    const FeatureMaps fb = features(lightness(b.channels[0]), pixels_per_degree);
    std::vector<float> values;
    values.reserve(perceived_a.size());
    for (std::size_t i = 0; i < perceived_a.size(); ++i) {
        const float colour = colour_difference(perceived_a[i], perceived_b[i]);
        const auto strength = [&](const Plane& x, const Plane& y) {
            return std::hypot(x.values[i], y.values[i]);
        };
        const float edges = std::abs(strength(fa.edge_x, fa.edge_y) - strength(fb.edge_x, fb.edge_y));
        const float points = std::abs(strength(fa.point_x, fa.point_y) - strength(fb.point_x, fb.point_y));
        const float feature = std::sqrt(std::max(edges, points) / std::numbers::sqrt2_v<float>);
        values.push_back(std::pow(colour, 1.0F - std::min(feature, 1.0F)));
    }
    return values;
}

double mean(std::span<const float> values) {
    double sum = 0.0;
    for (const float value : values) sum += static_cast<double>(value);
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

Result<RgbImage> read_png(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto bytes, read_file(path, std::size_t{1} << 28U, ErrorCode::failed));
    assets::Bitmap png;
    png.name = path.string();
    png.encoded.assign(bytes.begin(), bytes.end());
    if (Status decoded = assets::decode(png); !decoded) {
        Error error = decoded.error();
        error.file = path.string();
        return fail(std::move(error));
    }
    RgbImage image{png.width, png.height, {}};
    const auto channels = static_cast<std::size_t>(png.channels);
    for (std::size_t i = 0; i < png.pixels.size(); i += channels)
        for (std::size_t c = 0; c < 3; ++c) image.rgb.push_back(png.pixels[i + (channels >= 3 ? c : 0)]);
    return image;
}

Result<Difference> compare(const RgbImage& reference, const RgbImage& test) {
    if (reference.width != test.width || reference.height != test.height)
        return fail(ErrorCode::failed,
                    fmt::format("the images have different sizes, {}x{} and {}x{}", reference.width,
                                reference.height, test.width, test.height),
                    "equal sizes");
    Difference difference;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < reference.rgb.size(); i += 3) {
        int largest = 0;
        for (std::size_t c = i; c < i + 3; ++c)
            largest = std::max(largest, std::abs(int{reference.rgb[c]} - int{test.rgb[c]}));
        changed += largest > 0 ? 1U : 0U;
        difference.largest = std::max(difference.largest, largest);
    }
    difference.changed = static_cast<double>(changed) /
                         static_cast<double>(std::max<std::size_t>(reference.rgb.size() / 3, 1));
    difference.flips = flip(reference, test);
    difference.mean_flip = mean(difference.flips);
    return difference;
}

Status write_flips(const std::filesystem::path& path, const RgbImage& size, const std::vector<float>& flips) {
    std::vector<std::uint8_t> grey;
    grey.reserve(flips.size());
    for (const float value : flips)
        grey.push_back(static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(value, 0.0F, 1.0F))));
    BOLT_TRY_ASSIGN(const auto png, assets::encode_png(size.width, size.height, 1, grey));
    return write_file(path, png);
}

}  // namespace bolt::imagediff
