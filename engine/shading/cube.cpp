#include "engine/shading/cube.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace bolt::shading {

namespace {

glm::vec3 face_direction(std::uint32_t face, float s, float t) {
    switch (face) {
        case 0:
            return {1.0F, -t, -s};
        case 1:
            return {-1.0F, -t, s};
        case 2:
            return {s, 1.0F, t};
        case 3:
            return {s, -1.0F, -t};
        case 4:
            return {s, -t, 1.0F};
        default:
            return {-s, -t, -1.0F};
    }
}

float centre(std::uint32_t i, std::uint32_t size) {
    return (2.0F * static_cast<float>(i) + 1.0F) / static_cast<float>(size) - 1.0F;
}

// ∫∫ 1/(1 + s² + t²)^{3/2} from a face's centre to (s, t).
double area(double s, double t) { return std::atan2(s * t, std::sqrt(s * s + t * t + 1.0)); }

}  // namespace

glm::vec3 cube_direction(std::uint32_t face, std::uint32_t x, std::uint32_t y, std::uint32_t size) {
    return face_direction(face, centre(x, size), centre(y, size));
}

float texel_solid_angle(std::uint32_t x, std::uint32_t y, std::uint32_t size) {
    const double half = 1.0 / static_cast<double>(size);
    const double s = static_cast<double>(centre(x, size)), t = static_cast<double>(centre(y, size));
    return static_cast<float>(area(s - half, t - half) - area(s - half, t + half) - area(s + half, t - half) +
                              area(s + half, t + half));
}

glm::vec3 lookup(const Cube& cube, const glm::vec3& d) {
    const glm::vec3 a = glm::abs(d);
    std::uint32_t face = 0;
    float s = 0.0F, t = 0.0F, m = 1.0F;
    if (a.x >= a.y && a.x >= a.z) {
        face = d.x >= 0.0F ? 0 : 1;
        m = a.x;
        s = d.x >= 0.0F ? -d.z : d.z;
        t = -d.y;
    } else if (a.y >= a.z) {
        face = d.y >= 0.0F ? 2 : 3;
        m = a.y;
        s = d.x;
        t = d.y >= 0.0F ? d.z : -d.z;
    } else {
        face = d.z >= 0.0F ? 4 : 5;
        m = a.z;
        s = d.z >= 0.0F ? d.x : -d.x;
        t = -d.y;
    }
    const float size = static_cast<float>(cube.size);
    const float x = std::clamp((s / m + 1.0F) * 0.5F * size - 0.5F, 0.0F, size - 1.0F);
    const float y = std::clamp((t / m + 1.0F) * 0.5F * size - 0.5F, 0.0F, size - 1.0F);
    const auto x0 = static_cast<std::uint32_t>(x), y0 = static_cast<std::uint32_t>(y);
    const std::uint32_t x1 = std::min(x0 + 1, cube.size - 1), y1 = std::min(y0 + 1, cube.size - 1);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    return glm::mix(glm::mix(cube.at(face, x0, y0), cube.at(face, x1, y0), fx),
                    glm::mix(cube.at(face, x0, y1), cube.at(face, x1, y1), fx), fy);
}

Cube make_cube(const RadianceImage& image, std::uint32_t size) {
    Cube cube{size, {}};
    cube.texels.reserve(std::size_t{6} * size * size);
    for (std::uint32_t face = 0; face < 6; ++face) {
        for (std::uint32_t y = 0; y < size; ++y) {
            for (std::uint32_t x = 0; x < size; ++x) {
                glm::vec3 sum(0.0F);
                for (std::uint32_t k = 0; k < 4; ++k)
                    sum += lookup(
                        image, glm::normalize(cube_direction(face, 2 * x + k % 2, 2 * y + k / 2, 2 * size)));
                cube.texels.push_back(0.25F * sum);
            }
        }
    }
    return cube;
}

Cube halved(const Cube& cube) {
    Cube half{cube.size / 2, {}};
    half.texels.reserve(cube.texels.size() / 4);
    for (std::uint32_t face = 0; face < 6; ++face)
        for (std::uint32_t y = 0; y < half.size; ++y)
            for (std::uint32_t x = 0; x < half.size; ++x)
                half.texels.push_back(0.25F * (cube.at(face, 2 * x, 2 * y) + cube.at(face, 2 * x + 1, 2 * y) +
                                               cube.at(face, 2 * x, 2 * y + 1) +
                                               cube.at(face, 2 * x + 1, 2 * y + 1)));
    return half;
}

}  // namespace bolt::shading
