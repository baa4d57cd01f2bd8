#include "haptics/collision/jaw.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace bolt::collision {
namespace {

// Dimensions divided by the opening, as in tools/assets/models/wrench.cpp.
constexpr double thickness_share = 0.5, depth_share = 0.6, tip_share = 0.7, bevel_share = 0.025;
constexpr double lead_in_share = 0.035, round_share = 0.129;  // chords of the radii 0.06 and 0.22
constexpr double half_head_at_tip = 0.735;                    // half the width of the head at its tips

constexpr double slope = pi / 6.0;  // rad, of a nut's chamfers
constexpr double sixth = pi / 3.0;

Vec3 direction(double angle) { return {std::cos(angle), std::sin(angle), 0.0}; }

void add_end_planes(double half, std::vector<HalfSpace>& planes) {
    planes.push_back({{0, 0, 1}, half});
    planes.push_back({{0, 0, -1}, half});
}

HalfSpace plane_through(const Vec3& normal, const Vec3& point) {
    const Vec3 n = glm::normalize(normal);
    return {n, glm::dot(n, point)};
}

Result<Convex> rotated_convex(std::vector<HalfSpace> planes, double angle) {
    const Quat turn = glm::angleAxis(angle, Vec3(0, 0, 1));
    for (HalfSpace& plane : planes) plane.normal = turn * plane.normal;
    return make_convex(planes);
}

// One of the two jaws, on the side of +Y or −Y.
Result<Convex> half_jaw(const Jaw& j, double side) {
    const double flat = 0.5 * j.opening, back = jaw_cover * j.opening, half_thickness = 0.5 * j.thickness;
    const double head = half_head_at_tip * j.opening;
    std::vector<HalfSpace> planes{{{0, -side, 0}, -flat},
                                  {{0, side, 0}, flat + back},
                                  {{-1, 0, 0}, j.tip},
                                  {{1, 0, 0}, j.depth + back}};
    add_end_planes(half_thickness, planes);
    for (const double up : {1.0, -1.0})
        planes.push_back(plane_through({0, -side, up}, {0, side * flat, up * (half_thickness - j.bevel)}));
    planes.push_back(plane_through({-1, -side, 0}, {-j.tip, side * (flat + j.lead_in), 0}));
    planes.push_back(plane_through({-1, side, 0}, {-j.tip, side * (head - j.tip_chamfer), 0}));
    return rotated_convex(planes, j.head_angle);
}

Result<Convex> bottom(const Jaw& j) {
    const double wide = (0.5 + jaw_cover) * j.opening, half_thickness = 0.5 * j.thickness;
    std::vector<HalfSpace> planes{{{-1, 0, 0}, -j.depth},
                                  {{1, 0, 0}, j.depth + jaw_cover * j.opening},
                                  {{0, 1, 0}, wide},
                                  {{0, -1, 0}, wide}};
    add_end_planes(half_thickness, planes);
    for (const double up : {1.0, -1.0})
        planes.push_back(plane_through({-1, 0, up}, {j.depth, 0, up * (half_thickness - j.bevel)}));
    return rotated_convex(planes, j.head_angle);
}

// The length of the part of a line on which |coordinate| ≤ half. Along the line, of length `length`, the
// coordinate starts at `start` and changes by `rate` per unit of length.
double length_within(double start, double rate, double length, double half) {
    if (std::abs(rate) < 1e-12) return std::abs(start) <= half ? length : 0.0;
    const double a = (-half - start) / rate, b = (half - start) / rate;
    return std::clamp(std::max(a, b), 0.0, length) - std::clamp(std::min(a, b), 0.0, length);
}

// m from the origin of the solids' frame to their furthest point, or more.
double reach(std::span<const Convex> solids) {
    double furthest = 0.0;
    for (const Convex& solid : solids)
        furthest = std::max(furthest, glm::length(solid.middle) + solid.radius);
    return furthest;
}

}  // namespace

Jaw make_jaw(double opening, double head_angle, double thickness, double depth, double tip) {
    Jaw jaw;
    jaw.opening = opening;
    jaw.head_angle = head_angle;
    jaw.depth = depth > 0.0 ? depth : depth_share * opening;
    jaw.tip = tip > 0.0 ? tip : tip_share * opening;
    jaw.thickness = thickness > 0.0 ? thickness : thickness_share * opening;
    jaw.bevel = std::min(bevel_share * opening, 0.25 * jaw.thickness);
    jaw.lead_in = lead_in_share * opening;
    jaw.tip_chamfer = round_share * opening;
    return jaw;
}

double HexagonPrism::half_side() const { return 0.5 * across_flats / std::sqrt(3.0); }

double HexagonPrism::corner_drop() const {
    return std::max(0.0, across_flats / std::sqrt(3.0) - 0.5 * bearing) * std::tan(slope);
}

Result<JawParts> jaw_parts(const Jaw& jaw) {
    BOLT_TRY_ASSIGN(auto left, half_jaw(jaw, 1.0));
    BOLT_TRY_ASSIGN(auto right, half_jaw(jaw, -1.0));
    BOLT_TRY_ASSIGN(auto between, bottom(jaw));
    return JawParts{std::move(left), std::move(right), std::move(between)};
}

Result<Convex> hexagon(const HexagonPrism& p) {
    std::vector<HalfSpace> planes{{{0, 0, 1}, p.height}, {{0, 0, -1}, 0.0}};
    for (int i = 0; i < 6; ++i) planes.push_back({direction((i + 0.5) * sixth), 0.5 * p.across_flats});
    for (int i = 0; i < 12; ++i) {
        const Vec3 out = direction(0.5 * i * sixth);
        for (const double up : {1.0, -1.0}) {
            const Vec3 rim = 0.5 * p.bearing * out + Vec3(0, 0, up > 0.0 ? p.height : 0.0);
            planes.push_back(plane_through(std::sin(slope) * out + Vec3(0, 0, up * std::cos(slope)), rim));
        }
    }
    return make_convex(planes);
}

HeadFit jaw_fit(const Jaw& jaw, const HexagonPrism& prism, const Pose& wrench) {
    const Vec3 to_throat = wrench.orientation * direction(jaw.head_angle);
    const Vec3 across = wrench.orientation * direction(jaw.head_angle + 0.5 * pi);
    const Vec3 normal = wrench.orientation * Vec3(0, 0, 1);
    const double azimuth = std::atan2(to_throat.y, to_throat.x), off = wrap(azimuth, sixth);
    const Vec3 along = direction(azimuth - off), out = direction(azimuth - off + 0.5 * pi);

    HeadFit fit;
    fit.misalignment = -off;
    fit.tilt = std::asin(std::clamp(across.z, -1.0, 1.0));
    const Vec3 middle(0.0, 0.0, wrench.position.z);
    fit.lateral_offset = glm::dot(middle - wrench.position, across);
    const double corner_drop = prism.corner_drop(), side = prism.half_side();
    fit.overlap = prism.height;
    for (const double a : {-side, side})
        for (const double b : {-0.5, 0.5}) {
            const Vec3 corner = a * along + b * prism.across_flats * out + Vec3(0, 0, corner_drop);
            fit.overlap =
                std::min(fit.overlap, length_within(glm::dot(corner - wrench.position, normal), normal.z,
                                                    prism.height - 2.0 * corner_drop, jaw.half_flat()));
        }
    // m along the flats from the axis to the jaw's middle.
    const double ahead = glm::dot(wrench.position, along);
    fit.toward_mouth = std::min(side, jaw.tip - jaw.lead_in - ahead);
    fit.toward_throat = std::min(side, jaw.depth + ahead);
    return fit;
}

double grip_reach(const GripSolids& solids) {
    constexpr double rounding = 1e-9;  // m, more than the rounding errors of the distances
    return reach(solids.head) + reach(solids.turned_part) + rounding;
}

std::size_t solid_contacts(const GripSolids& solids, const Pose& tool, const Pose& turned_part, double band,
                           ObstacleId obstacle, std::span<Contact, max_grip_contacts> out) {
    const Pose to_part = inverse(turned_part) * tool;
    const std::size_t room = max_grip_contacts / (solids.head.size() * solids.turned_part.size());
    std::size_t count = 0;
    std::uint32_t pair = 0;
    for (const Convex& head : solids.head)
        for (const Convex& part : solids.turned_part) {
            const std::uint32_t features = 64 * pair++;
            const Separation s = separation(head, part, to_part, band);
            if (s.distance > band) continue;
            std::array<Contact, max_contact_points> found;
            const std::size_t points = contact_points(head, part, to_part, s, found);
            std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(points),
                      [](const Contact& a, const Contact& b) {
                          return a.distance != b.distance ? a.distance < b.distance : a.feature < b.feature;
                      });
            for (std::size_t i = 0; i < std::min(points, room); ++i) {
                Contact& c = out[count++];
                c = found[i];
                c.on_tool = turned_part * c.on_tool;
                c.on_obstacle = turned_part * c.on_obstacle;
                c.normal = turned_part.orientation * c.normal;
                c.obstacle = obstacle;
                c.feature += features;
            }
        }
    return count;
}

void remove_axial_moment(const Vec3& on_axis, const Vec3& axis, std::span<Contact> contacts) {
    for (Contact& c : contacts) {
        const Vec3 tangent = glm::cross(axis, c.normal);
        const double square_level = glm::dot(tangent, tangent);
        if (square_level < 1e-12) continue;
        const double lever = glm::dot(axis, glm::cross(c.on_obstacle - on_axis, c.normal));
        const Vec3 shift = tangent * (lever / square_level);
        c.on_tool += shift;
        c.on_obstacle += shift;
    }
}

}  // namespace bolt::collision
