#include "tools/author/geometry/drawn_thread.hpp"

#include <cmath>

namespace bolt::geometry {

namespace {

// Radii of a thread's flanks, as fractions of the diameter: from near the root of a bolt to the groove of a
// nut, with its allowance.
constexpr double min_flank_radius = 0.36, max_flank_radius = 0.53;
// Bounds of |n·y| on a flank (y: the axis); 0.87 at a flank angle of 60°. Faces across the axis and the
// crests are no flanks.
constexpr double min_axial = 0.5, max_axial = 0.97;
// A standard pitch is 0.06 … 0.25 of the diameter (ISO 262). A plain shank has 0.
constexpr double min_pitch_ratio = 0.02, max_pitch_ratio = 0.4;
// Minimum share of the flank area whose pitch has the same sign.
constexpr double min_agreement = 0.9;

}  // namespace

std::optional<DrawnThread> measure_drawn_thread(std::span<const Triangle> triangles, double diameter) {
    double product = 0.0, square_sum = 0.0, rising = 0.0, falling = 0.0;
    for (const Triangle& triangle : triangles) {
        const Vec3 middle = (triangle.a + triangle.b + triangle.c) / 3.0;
        const double radius = std::hypot(middle.x, middle.z);
        if (radius < min_flank_radius * diameter || radius > max_flank_radius * diameter) continue;
        const Vec3 normal = normal_of(triangle);
        const double length = glm::length(normal);
        if (length <= 0.0) continue;
        const Vec3 n = normal / length;
        if (std::abs(n.y) < min_axial || std::abs(n.y) > max_axial) continue;
        const double about = (n.x * middle.z - n.z * middle.x) / radius;
        product += length * -2.0 * pi * radius * about * n.y;
        square_sum += length * n.y * n.y;
        (about * n.y < 0.0 ? rising : falling) += length;
    }
    if (square_sum <= 0.0) return std::nullopt;
    const double pitch = product / square_sum;
    if (std::abs(pitch) < min_pitch_ratio * diameter || std::abs(pitch) > max_pitch_ratio * diameter)
        return std::nullopt;
    if (std::max(rising, falling) < min_agreement * (rising + falling)) return std::nullopt;
    return DrawnThread{pitch > 0.0 ? joint::ThreadDirection::right : joint::ThreadDirection::left,
                       std::abs(pitch)};
}

}  // namespace bolt::geometry
