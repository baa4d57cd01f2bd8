#include "tools/assets/models/reducer/gear.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace bolt::models::reducer {
namespace {

Point2 turned(Point2 p, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    return {c * p.x - s * p.y, s * p.x + c * p.y};
}

// The rounded tip of the rack-shaped tool, relative to the gear's reference circle and the gap's middle.
struct ToolTip {
    double rounding = 0.0;
    double depth = 0.0;    // of the rounding's centre below the rolling line
    double lateral = 0.0;  // of the rounding's centre from the middle of the tool's tooth
};

ToolTip tool_tip(const GearSpec& gear, const GearCircles& c) {
    const double m = gear.module_mm;
    const double alpha = c.transverse_pressure_angle;
    ToolTip tip;
    tip.rounding = tool_rounding * m;
    tip.depth = (dedendum - tool_rounding - gear.shift) * m;
    tip.lateral = std::numbers::pi * c.transverse_module_mm / 4.0 -
                  (dedendum - tool_rounding) * m * std::tan(alpha) - tip.rounding / std::cos(alpha) +
                  gear.thinning_mm / 2.0;
    return tip;
}

// The point of the fillet that the tool's rounding generates when the rack has moved by `roll`, and the
// profile's tangent there.
void fillet_point(const ToolTip& tip, double r, double roll, Point2& point, Point2& tangent) {
    const Point2 arm{-tip.depth, tip.lateral + roll};  // from the rolling point to the rounding's centre
    const double length = std::hypot(arm.x, arm.y);
    const Point2 normal{arm.x / length, arm.y / length};
    const Point2 at{r + arm.x + tip.rounding * normal.x, arm.y + tip.rounding * normal.y};
    point = turned(at, -roll / r);
    tangent = turned({normal.y, -normal.x}, -roll / r);
}

// The arc length of the fillet between two positions of the rack. The chords are so short that their sum is
// exact to a nanometre.
double fillet_length(const ToolTip& tip, double r, double from, double to) {
    constexpr int steps = 2000;
    double length = 0.0;
    Point2 before, point, tangent;
    fillet_point(tip, r, from, before, tangent);
    for (int i = 1; i <= steps; ++i, before = point) {
        fillet_point(tip, r, from + (to - from) * i / steps, point, tangent);
        length += std::hypot(point.x - before.x, point.y - before.y);
    }
    return length;
}

}  // namespace

GearCircles circles(const GearSpec& gear) {
    const double m = gear.module_mm;
    GearCircles c;
    c.transverse_module_mm = m / std::cos(gear.helix);
    c.transverse_pressure_angle = std::atan(std::tan(pressure_angle) / std::cos(gear.helix));
    c.reference_mm = gear.teeth * c.transverse_module_mm;
    c.base_mm = c.reference_mm * std::cos(c.transverse_pressure_angle);
    c.tip_mm = c.reference_mm + 2.0 * m * (addendum + gear.shift);
    c.root_mm = c.reference_mm - 2.0 * m * (dedendum - gear.shift);
    return c;
}

double least_shift(const GearSpec& gear) {
    const double s = std::sin(circles(gear).transverse_pressure_angle);
    return addendum - gear.teeth * s * s / (2.0 * std::cos(gear.helix));
}

double involute(double angle) { return std::tan(angle) - angle; }

double half_tooth_angle(const GearSpec& gear, double radius_mm) {
    const GearCircles c = circles(gear);
    const double thickness =
        c.transverse_module_mm * (std::numbers::pi / 2.0 + 2.0 * gear.shift * std::tan(pressure_angle)) -
        gear.thinning_mm;
    return thickness / c.reference_mm + involute(c.transverse_pressure_angle) -
           involute(std::acos(std::min(1.0, c.base_mm / (2.0 * radius_mm))));
}

double twist(const GearSpec& gear, double distance_mm) {
    const double sense = gear.hand == Hand::right ? 1.0 : -1.0;
    return sense * distance_mm * std::tan(gear.helix) / (circles(gear).reference_mm / 2.0);
}

FlankProfile flank_profile(const GearSpec& gear, int fillet_points, int flank_points) {
    const GearCircles c = circles(gear);
    const ToolTip tip = tool_tip(gear, c);
    const double r = c.reference_mm / 2.0, base = c.base_mm / 2.0;
    FlankProfile profile;

    // Even steps of the normal's direction follow the curvature of the fillet.
    const double end_angle = std::numbers::pi / 2.0 - c.transverse_pressure_angle;
    for (int i = 0; i < fillet_points; ++i) {
        const double roll = tip.depth * std::tan(end_angle * i / (fillet_points - 1)) - tip.lateral;
        Point2 point, tangent;
        fillet_point(tip, r, roll, point, tangent);
        profile.fillet.push_back(point);
        profile.fillet_lengths.push_back(fillet_length(tip, r, -tip.lateral, roll));
        if (i == 0) profile.fillet_start_tangent = tangent;
        if (i == fillet_points - 1) profile.fillet_end_tangent = tangent;
    }

    // Even steps of the roll angle tan(alpha): in that parameter the involute is closest to a polynomial.
    const Point2 join = profile.fillet.back();
    const double first = std::sqrt(std::max(0.0, (join.x * join.x + join.y * join.y) / (base * base) - 1.0));
    const double last = std::sqrt(c.tip_mm * c.tip_mm / (c.base_mm * c.base_mm) - 1.0);
    for (int i = 0; i < flank_points; ++i) {
        const double roll = first + (last - first) * i / (flank_points - 1);
        const double radius = base * std::sqrt(1.0 + roll * roll);
        const double angle = std::numbers::pi / gear.teeth - half_tooth_angle(gear, radius);
        profile.flank_lengths.push_back(base * (roll * roll - first * first) / 2.0);
        profile.flank.push_back({radius * std::cos(angle), radius * std::sin(angle)});
        if (i == flank_points - 1) {
            // The angle between the involute and the radius is the pressure angle, here atan(roll).
            const double direction = angle + std::atan(roll);
            profile.flank_end_tangent = {std::cos(direction), std::sin(direction)};
        }
    }
    return profile;
}

}  // namespace bolt::models::reducer
