#include "tools/author/import/placed_fasteners.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "tools/author/import/clamped_members.hpp"
#include "tools/author/import/metric_size.hpp"
#include "tools/author/import/names.hpp"

namespace bolt::step_import {

PlacedFastener place(int node, const FastenerShape& shape, const ScaledPose& pose) {
    const double scale = std::abs(pose.scale);
    std::optional<CapHead> cap = shape.cap;
    if (cap) cap = CapHead{cap->width * scale, cap->height * scale, cap->depth * scale};
    return {shape.kind,
            node,
            pose.point(shape.origin),
            pose.direction(shape.axis),
            shape.across_flats * scale,
            shape.low * scale,
            shape.high * scale,
            shape.diameter * scale,
            cap,
            shape.drawn_thread};
}

PlacedFastener reversed(PlacedFastener placed) {
    placed.axis = -placed.axis;
    std::tie(placed.low, placed.high) = std::pair(-placed.high, -placed.low);
    return placed;
}

const joint::FastenerSize* metric_size_of(const PlacedFastener& bolt) {
    if (bolt.kind == FastenerKind::stud) return size_of_thread(bolt.diameter);
    return bolt.cap ? size_of(bolt.diameter, bolt.across_flats, *bolt.cap)
                    : size_of(bolt.diameter, bolt.across_flats);
}

std::string explain_metric_size(const PlacedFastener& bolt) {
    return bolt.cap ? explain_size(bolt.diameter, bolt.across_flats, *bolt.cap) : explain_size(bolt.diameter);
}

bool nut_fits(const PlacedFastener& bolt, const PlacedFastener& nut) {
    const bool has_hexagon = bolt.kind == FastenerKind::bolt && !bolt.cap;
    return !has_hexagon ? size_of(bolt.diameter, nut.across_flats) != nullptr
                        : std::abs(nut.across_flats - bolt.across_flats) <= width_tolerance;
}

std::string describe(const PlacedFastener& bolt) {
    if (bolt.kind == FastenerKind::stud)
        return fmt::format("looks like a stud (rod {:.2f} mm thick and {:.2f} mm long)", bolt.diameter / mm,
                           (bolt.high - bolt.low) / mm);
    if (!bolt.cap)
        return fmt::format("looks like a bolt (cylinder {:.2f} mm, hexagon {:.2f} mm across flats)",
                           bolt.diameter / mm, bolt.across_flats / mm);
    return fmt::format(
        "looks like a cap screw (cylinder {:.2f} mm, socket {:.2f} mm across flats and {:.2f} mm deep, head "
        "{:.2f} mm wide and {:.2f} mm high)",
        bolt.diameter / mm, bolt.across_flats / mm, bolt.cap->depth / mm, bolt.cap->width / mm,
        bolt.cap->height / mm);
}

std::pair<double, double> along(const PlacedFastener& placed, const Vec3& origin, const Vec3& axis) {
    const auto height = [&](double h) { return glm::dot(placed.origin + h * placed.axis - origin, axis); };
    const double a = height(placed.low), b = height(placed.high);
    return {std::min(a, b), std::max(a, b)};
}

double distance_from_axis(const PlacedFastener& placed, const Vec3& point) {
    return glm::length(glm::cross(point - placed.origin, placed.axis));
}

bool named_like_fastener(const std::string& name) {
    for (const char* pattern : {"*bolt*", "*screw*", "*nut*", "*hex*", "*stud*", "*fastener*", "*schraube*",
                                "*mutter*", "*boulon*", "*ecrou*", "*tornillo*", "*tuerca*"})
        if (matches(pattern, name)) return true;
    return false;
}

}  // namespace bolt::step_import
