#include "tools/pathtrace/environment.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace bolt::pathtrace {

namespace {

constexpr float pi = std::numbers::pi_v<float>;

glm::vec2 to_square(const glm::vec3& d) {
    return {0.5F + std::atan2(d.x, -d.z) / (2.0F * pi), std::acos(std::clamp(d.y, -1.0F, 1.0F)) / pi};
}

glm::vec3 to_direction(const glm::vec2& uv) {
    const float theta = uv.y * pi;
    const float phi = (uv.x - 0.5F) * 2.0F * pi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

double luminance(const glm::vec3& c) {
    return 0.2126 * static_cast<double>(c.r) + 0.7152 * static_cast<double>(c.g) +
           0.0722 * static_cast<double>(c.b);
}

std::size_t pixel(const RadianceImage& image, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

// Brightness of a soft box that is seen in `direction`: a rectangle on a plane at distance one, with soft
// rims.
struct SoftBox {
    glm::vec3 towards;    // its middle, any length
    glm::vec2 half_size;  // in distances
    float radiance;
};

float brightness(const SoftBox& box, const glm::vec3& direction) {
    const glm::vec3 n = glm::normalize(box.towards);
    const float along = glm::dot(direction, n);
    if (along <= 0.05F) return 0.0F;
    const glm::vec3 up = std::abs(n.y) < 0.95F ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, -1);
    const glm::vec3 right = glm::normalize(glm::cross(up, n));
    const glm::vec2 place(glm::dot(direction, right) / along,
                          glm::dot(direction, glm::cross(n, right)) / along);
    const glm::vec2 inside = box.half_size - glm::abs(place);
    const auto soft = [](float x) { return glm::smoothstep(-0.06F, 0.06F, x); };
    return box.radiance * soft(inside.x) * soft(inside.y);
}

}  // namespace

RadianceImage constant(const glm::vec3& radiance) { return {8, 4, std::vector<glm::vec3>(32, radiance)}; }

RadianceImage studio(int width) {
    const SoftBox boxes[] = {
        {{-0.55F, 1.0F, 0.65F}, {0.55F, 0.45F}, 3.6F},  // key, above on the left
        {{1.0F, 0.35F, 0.35F}, {0.35F, 0.75F}, 1.3F},   // fill, on the right
        {{-0.9F, 0.25F, -0.75F}, {0.18F, 0.9F}, 2.6F},  // rim, behind on the left
        {{0.5F, 0.5F, -1.0F}, {0.7F, 0.18F}, 1.6F},     // strip behind
    };
    RadianceImage image{width, width / 2, {}};
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const glm::vec3 d =
                to_direction({(static_cast<float>(x) + 0.5F) / static_cast<float>(image.width),
                              (static_cast<float>(y) + 0.5F) / static_cast<float>(image.height)});
            float value = glm::mix(0.06F, 0.30F, glm::smoothstep(-0.6F, 1.0F, d.y));
            for (const SoftBox& box : boxes) value += brightness(box, d);
            image.pixels.emplace_back(value);
        }
    }
    return image;
}

Environment::Environment(RadianceImage image) : image_(std::move(image)) {
    // Bilinear filtering spreads a bright pixel over its neighbours, which must be found there too.
    double mean = 0.0;
    for (const glm::vec3& value : image_.pixels) mean += luminance(value);
    mean /= static_cast<double>(image_.pixels.size());
    for (int y = 0; y < image_.height; ++y) {
        const float sine = std::sin((static_cast<float>(y) + 0.5F) / static_cast<float>(image_.height) * pi);
        double row = 0.0;
        for (int x = 0; x < image_.width; ++x) {
            double weight = 0.02 * mean;
            for (int dx = -1; dx <= 1; ++dx) {
                for (int dy = -1; dy <= 1; ++dy) {
                    const int nx = (x + dx + image_.width) % image_.width;
                    const int ny = std::clamp(y + dy, 0, image_.height - 1);
                    weight +=
                        luminance(image_.pixels[pixel(image_, nx, ny)]) * (dx == 0 && dy == 0 ? 0.5 : 0.0625);
                }
            }
            row += weight * static_cast<double>(sine);
            columns_.push_back(row);
        }
        total_ += row;
        rows_.push_back(total_);
    }
}

glm::vec3 Environment::radiance(const glm::vec3& direction) const {
    if (image_.pixels.empty()) return glm::vec3(0.0F);
    const glm::vec2 place = to_square(direction) * glm::vec2(image_.width, image_.height) - 0.5F;
    const glm::vec2 corner = glm::floor(place);
    const glm::vec2 f = place - corner;
    const int x = static_cast<int>(corner.x);
    const int y = static_cast<int>(corner.y);
    const auto at = [&](int px, int py) {
        return image_
            .pixels[pixel(image_, (px + image_.width) % image_.width, std::clamp(py, 0, image_.height - 1))];
    };
    return glm::mix(glm::mix(at(x, y), at(x + 1, y), f.x), glm::mix(at(x, y + 1), at(x + 1, y + 1), f.x),
                    f.y);
}

DirectionSample Environment::sample(const glm::vec2& u) const {
    // The row, then the column, by their running sums; what is left of u places the point within the pixel.
    const double wanted = static_cast<double>(u.y) * total_;
    const auto row = std::min<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(rows_.begin(), rows_.end(), wanted) - rows_.begin()),
        rows_.size() - 1);
    const double below = row > 0 ? rows_[row - 1] : 0.0;
    const double fy = (wanted - below) / (rows_[row] - below);
    const auto width = static_cast<std::size_t>(image_.width);
    const auto first = columns_.begin() + static_cast<std::ptrdiff_t>(row * width);
    const auto last = first + static_cast<std::ptrdiff_t>(width);
    const double in_row = static_cast<double>(u.x) * *(last - 1);
    const auto column = std::min<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(first, last, in_row) - first), width - 1);
    const double left = column > 0 ? *(first + static_cast<std::ptrdiff_t>(column) - 1) : 0.0;
    const double fx = (in_row - left) / (*(first + static_cast<std::ptrdiff_t>(column)) - left);
    const glm::vec2 uv(
        (static_cast<float>(column) + static_cast<float>(fx)) / static_cast<float>(image_.width),
        (static_cast<float>(row) + static_cast<float>(fy)) / static_cast<float>(image_.height));
    const glm::vec3 direction = to_direction(uv);
    return {direction, density(direction)};
}

float Environment::density(const glm::vec3& direction) const {
    if (dark()) return 0.0F;
    const glm::vec2 uv = to_square(direction);
    const int x = std::clamp(static_cast<int>(uv.x * static_cast<float>(image_.width)), 0, image_.width - 1);
    const int y =
        std::clamp(static_cast<int>(uv.y * static_cast<float>(image_.height)), 0, image_.height - 1);
    const std::size_t place = pixel(image_, x, y);
    const double weight = columns_[place] - (x > 0 ? columns_[place - 1] : 0.0);
    // Per unit square, then per solid angle: du dv covers 2π² sin θ.
    const double pixels = static_cast<double>(image_.width) * static_cast<double>(image_.height);
    const double sine = std::max(1e-6, std::sin(static_cast<double>(uv.y) * std::numbers::pi));
    return static_cast<float>(weight / total_ * pixels / (2.0 * std::numbers::pi * std::numbers::pi * sine));
}

}  // namespace bolt::pathtrace
