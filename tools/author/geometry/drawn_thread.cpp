#include "tools/author/geometry/drawn_thread.hpp"

#include <cmath>

namespace bolt::geometry {

namespace {

// Radii of a thread's flanks, as fractions of the diameter: from the root of a bolt of any pitch to the
// groove of a nut, with the allowance.
constexpr double least_flank_radius = 0.36, greatest_flank_radius = 0.53;
// Of the share of a flank's normal along the axis: 0.87 with flanks at 60°. Faces across the axis and the
// crests are no flanks.
constexpr double least_axial = 0.5, greatest_axial = 0.97;
// A standard pitch is 0.06 … 0.25 of the diameter (ISO 262). A plain shank has 0.
constexpr double least_pitch_ratio = 0.02, greatest_pitch_ratio = 0.4;
// Of the flanks' area that has to rise in the direction of the helix.
constexpr double least_agreement = 0.9;

}  // namespace

// A surface that a screw motion maps to itself contains the direction of that motion. With t: the unit vector
// about the axis, its normal n meets n · (r t + P/2π y) = 0, so that P = −2π r (n·t)/(n·y) on each triangle.
std::optional<DrawnThread> measure_drawn_thread(std::span<const Triangle> triangles, double diameter) {
    double product = 0.0, square_sum = 0.0, rising = 0.0, falling = 0.0;
    for (const Triangle& triangle : triangles) {
        const Vec3 middle = (triangle.a + triangle.b + triangle.c) / 3.0;
        const double radius = std::hypot(middle.x, middle.z);
        if (radius < least_flank_radius * diameter || radius > greatest_flank_radius * diameter) continue;
        const Vec3 normal = normal_of(triangle);
        const double length = glm::length(normal);
        if (length <= 0.0) continue;
        const Vec3 n = normal / length;
        if (std::abs(n.y) < least_axial || std::abs(n.y) > greatest_axial) continue;
        const double about = (n.x * middle.z - n.z * middle.x) / radius;
        product += length * -2.0 * pi * radius * about * n.y;
        square_sum += length * n.y * n.y;
        (about * n.y < 0.0 ? rising : falling) += length;
    }
    if (square_sum <= 0.0) return std::nullopt;
    const double pitch = product / square_sum;
    if (std::abs(pitch) < least_pitch_ratio * diameter || std::abs(pitch) > greatest_pitch_ratio * diameter)
        return std::nullopt;
    if (std::max(rising, falling) < least_agreement * (rising + falling)) return std::nullopt;
    return DrawnThread{pitch > 0.0 ? joint::ThreadDirection::right : joint::ThreadDirection::left,
                       std::abs(pitch)};
}

}  // namespace bolt::geometry
