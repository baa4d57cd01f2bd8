#include "tools/verify/pathtrace/environment.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "tools/verify/pathtrace/sampler.hpp"

namespace bolt::pathtrace {

namespace {

double luminance(const glm::vec3& c) {
    return 0.2126 * static_cast<double>(c.r) + 0.7152 * static_cast<double>(c.g) +
           0.0722 * static_cast<double>(c.b);
}

std::size_t pixel(const RadianceImage& image, int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(x);
}

}  // namespace

Environment::Environment(RadianceImage image) : image_(std::move(image)) {
    // Bilinear filtering spreads a bright pixel over its neighbours, so each weight includes the neighbours.
    double mean = 0.0;
    for (const glm::vec3& value : image_.pixels) mean += luminance(value);
    mean /= static_cast<double>(image_.pixels.size());
    for (int y = 0; y < image_.height; ++y) {
        const float sine =
            std::sin((static_cast<float>(y) + 0.5F) / static_cast<float>(image_.height) * pi_float);
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
    return image_.pixels.empty() ? glm::vec3(0.0F) : shading::lookup(image_, direction);
}

DirectionSample Environment::sample(const glm::vec2& u) const {
    // Select the row, then the column, by their running sums. The rest of u is the position in the pixel.
    const double target = static_cast<double>(u.y) * total_;
    const auto row = std::min<std::size_t>(
        static_cast<std::size_t>(std::upper_bound(rows_.begin(), rows_.end(), target) - rows_.begin()),
        rows_.size() - 1);
    const double below = row > 0 ? rows_[row - 1] : 0.0;
    const double fy = (target - below) / (rows_[row] - below);
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
    const glm::vec3 direction = shading::to_direction(uv);
    return {direction, density(direction)};
}

float Environment::density(const glm::vec3& direction) const {
    if (dark()) return 0.0F;
    const glm::vec2 uv = shading::to_equirectangular(direction);
    const int x = std::clamp(static_cast<int>(uv.x * static_cast<float>(image_.width)), 0, image_.width - 1);
    const int y =
        std::clamp(static_cast<int>(uv.y * static_cast<float>(image_.height)), 0, image_.height - 1);
    const std::size_t index = pixel(image_, x, y);
    const double weight = columns_[index] - (x > 0 ? columns_[index - 1] : 0.0);
    // Per unit square, then per solid angle: du dv covers 2π² sin θ.
    const double pixels = static_cast<double>(image_.width) * static_cast<double>(image_.height);
    const double sine = std::max(1e-6, std::sin(static_cast<double>(uv.y) * std::numbers::pi));
    return static_cast<float>(weight / total_ * pixels / (2.0 * std::numbers::pi * std::numbers::pi * sine));
}

}  // namespace bolt::pathtrace
