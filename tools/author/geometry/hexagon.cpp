#include "tools/author/geometry/hexagon.hpp"

#include <algorithm>
#include <array>
#include <complex>
#include <vector>

namespace bolt::geometry {

namespace {

struct Flat {
    double angle, distance, area;
};

// Triangles that stand upright near the distance of a flat: neither the bore, nor the chamfers, nor a collar.
std::vector<Flat> upright(std::span<const Triangle> triangles, double corner) {
    std::vector<Flat> flats;
    for (const Triangle& t : triangles) {
        Vec3 n = normal_of(t);
        const double twice = std::sqrt(glm::dot(n, n));
        if (twice <= 0.0) continue;
        n /= twice;
        if (std::abs(n.y) > 0.02) continue;
        const double distance = glm::dot(n, t.a);
        if (std::abs(distance) < 0.8 * corner || std::abs(distance) > 0.95 * corner) continue;
        // Whichever way round the triangle is wound.
        const double side = distance < 0.0 ? -1.0 : 1.0;
        flats.push_back({std::atan2(side * n.z, side * n.x), std::abs(distance), 0.5 * twice});
    }
    return flats;
}

}  // namespace

std::optional<Hexagon> measure_hexagon(std::span<const Triangle> triangles) {
    Hexagon hexagon;
    double corner = 0.0;
    Box box;
    for (const Triangle& t : triangles)
        for (const Vec3& p : {t.a, t.b, t.c}) {
            corner = std::max(corner, std::hypot(p.x, p.z));
            box.add(p);
        }
    const std::vector<Flat> flats = upright(triangles, corner);
    // Six directions 60° apart point the same way when their angles are taken six times.
    std::complex<double> sum;
    for (const Flat& flat : flats) sum += std::polar(flat.area, 6.0 * flat.angle);
    if (flats.empty()) return std::nullopt;
    const double phase = std::arg(sum) / 6.0;
    constexpr double window = to_radians(2.0);
    std::array<double, 6> support{};
    for (std::size_t k = 0; k < 6; ++k)
        for (const Flat& flat : flats)
            if (std::abs(wrap(flat.angle - phase - static_cast<double>(k) * pi / 3.0, 2.0 * pi)) < window)
                support[k] = std::max(support[k], flat.distance);
    if (*std::min_element(support.begin(), support.end()) <= 0.0) return std::nullopt;
    const std::array<double, 3> widths = {support[0] + support[3], support[1] + support[4],
                                          support[2] + support[5]};
    const auto [least, most] = std::minmax_element(widths.begin(), widths.end());
    hexagon.across_flats = (widths[0] + widths[1] + widths[2]) / 3.0;
    hexagon.unevenness = *most - *least;
    for (std::size_t k = 0; k < 6; ++k) {
        const double angle = phase + static_cast<double>(k) * pi / 3.0;
        hexagon.centre += support[k] / 3.0 * Vec3{std::cos(angle), 0.0, std::sin(angle)};
    }
    hexagon.low = box.low.y;
    hexagon.high = box.high.y;
    return hexagon;
}

}  // namespace bolt::geometry
