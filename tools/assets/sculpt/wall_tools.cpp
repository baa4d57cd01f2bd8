#include "tools/assets/sculpt/wall_tools.hpp"

#include <algorithm>
#include <array>

#include "tools/assets/sculpt/workshop_materials.hpp"

namespace bolt::sculpt {
namespace {

// A flat shape of the given half thickness with rounded edges, from its distance in the plane.
double plate(double flat, double z, double half, double round) {
    return smooth_intersection(flat, std::abs(z) - half, round);
}

double hexagon(double x, double y, double half_width) {
    const double ax = std::abs(x);
    const double ay = std::abs(y);
    return std::max(ax, 0.5 * ax + 0.8660254037844386 * ay) - half_width;
}

}  // namespace

// A combination spanner, ring up, jaw down, proportions of ISO 7738.
void hang_spanner(Solid& out, const Vec3& peg, double across_flats_mm) {
    const double s = across_flats_mm * mm;
    const double length = 7.2 * s + 55 * mm;  // from ring to jaw
    const double ring_half = 0.34 * s;
    const auto field = [=](const Vec3& p) {
        const double ring = plate(std::hypot(p.x, p.y) - 0.76 * s, p.z, ring_half, 1.5 * mm);
        const Vec3 jaw_at(p.x, p.y + length, p.z);
        const double c = std::cos(to_radians(15.0));
        const double sn = std::sin(to_radians(15.0));
        const double jx = c * jaw_at.x - sn * jaw_at.y;
        const double jy = sn * jaw_at.x + c * jaw_at.y;
        const double jaw = plate(std::hypot(jx, jy - 0.08 * s) - 1.06 * s, p.z, 0.26 * s, 1.5 * mm);
        const double t = std::clamp(-p.y / length, 0.0, 1.0);
        const double beam = plate(std::abs(p.x) - (0.36 - 0.04 * t) * s, p.z, 0.16 * s, 0.12 * s);
        const double shaft = std::max(beam, std::max(p.y, -p.y - length));
        double d = smooth_union(smooth_union(ring, shaft, 0.35 * s), jaw, 0.35 * s);
        d = smooth_difference(d, hexagon(p.x, p.y, 0.5 * s), 0.8 * mm);
        const double mouth = std::max(std::abs(jx) - 0.5 * s, jy - 0.45 * s);
        return smooth_difference(d, mouth, 0.8 * mm);
    };
    const Box box{{-1.2 * s, -length - 1.3 * s, -0.5 * s}, {1.2 * s, 0.95 * s, 0.5 * s}};
    out.sculpted(tool_chrome, field, box, std::max(0.9 * mm, 0.045 * s), 1700,
                 peg + Vec3(0.0, -0.42 * s, ring_half + 1 * mm));
}

// An engineer's hammer, head up.
void hang_hammer(Solid& out, const Vec3& peg) {
    const Vec3 at = peg + Vec3(0.0, -24 * mm, 20 * mm);
    const auto head = [](const Vec3& p) {
        const double taper = 15 * mm - 0.09 * std::max(p.x, 0.0);
        const double block = rounded_box(p, Vec3(34 * mm, taper, 14.5 * mm), 4 * mm);
        const double peen =
            rounded_box(p - Vec3(48, 0, 0) * mm,
                        Vec3(16 * mm, 14 * mm - 0.62 * std::max(p.x - 32 * mm, 0.0), 13 * mm), 3 * mm);
        const double face = rounded_box(p - Vec3(-41, 0, 0) * mm, Vec3(12, 15, 15) * mm, 5 * mm);
        return smooth_union(smooth_union(block, peen, 3 * mm), face, 4 * mm);
    };
    out.sculpted(tool_black, head, {Vec3(-60, -24, -22) * mm, Vec3(70, 24, 22) * mm}, 1.3 * mm, 900, at);
    const auto handle = [](const Vec3& p) {
        const double t = std::clamp(-p.y / (300 * mm), 0.0, 1.0);
        const double swell = 1.0 + 0.22 * std::sin(pi * (t * 1.35 - 0.25));
        const double round =
            (std::hypot(p.x / (13 * mm * swell), p.z / (9.5 * mm * swell)) - 1.0) * 9.5 * mm * swell;
        return smooth_intersection(round, std::abs(p.y + 142 * mm) - 158 * mm, 5 * mm);
    };
    out.sculpted(beech, handle, {Vec3(-24, -310, -18) * mm, Vec3(24, 26, 18) * mm}, 1.6 * mm, 900, at);
}

// Blade down, handle up.
void hang_screwdriver(Solid& out, const Vec3& peg, double length) {
    const Vec3 at = peg + Vec3(0.0, -60 * mm, 17 * mm);
    const auto handle = [](const Vec3& p) {
        const double turn = std::atan2(p.z, p.x);
        const double flute = 0.9 * mm * std::cos(6.0 * turn);
        const double y = p.y / mm;
        const double radius = 14.5 * mm - 2.5 * mm * std::exp(-square((y + 42) / 9.0)) -
                              flute * smooth_step(58, 40, y) * smooth_step(-34, -20, y);
        return smooth_intersection(std::hypot(p.x, p.z) - radius, std::abs(p.y) - 57 * mm, 10 * mm);
    };
    out.sculpted(tool_grip, handle, {Vec3(-20, -62, -20) * mm, Vec3(20, 62, 20) * mm}, 1.2 * mm, 1100, at);
    const std::array<glm::dvec2, 6> blade{{{0.0, 0.0},
                                           {2.2 * mm, 0.0},
                                           {4.6 * mm, 14 * mm},
                                           {3.2 * mm, 22 * mm},
                                           {3.2 * mm, length},
                                           {0.0, length}}};
    out.turned(tool_chrome, at - Vec3(0.0, 55 * mm + length, 0.0), blade, 16);
}

}  // namespace bolt::sculpt
