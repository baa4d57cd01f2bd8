// The geometry of helical involute gears in the transverse plane, by the formulas of ISO 21771 for profile A
// of ISO 53. Lengths in millimetres, angles in radians. Does not depend on the CAD library. The solid and its
// tests share it.
#pragma once

#include <vector>

namespace bolt::models::reducer {

enum class HelixHand { right, left };

struct GearSpec {
    int teeth = 0;
    double module_mm = 0.0;  // normal module m_n
    double helix = 0.0;      // beta, at the reference cylinder
    HelixHand hand = HelixHand::right;
    double shift = 0.0;     // profile shift coefficient x
    double width_mm = 0.0;  // face width b
    // Reduction of the transverse tooth thickness at the reference circle, for backlash.
    double thinning_mm = 0.0;
};

// ISO 53, profile A: normal pressure angle, addendum, dedendum and tip rounding of the tool, in modules.
inline constexpr double pressure_angle = 0.34906585039886592;  // 20 degrees
inline constexpr double addendum = 1.0;
inline constexpr double dedendum = 1.25;
inline constexpr double tool_rounding = 0.38;

struct GearCircles {
    double transverse_module_mm = 0.0;
    double transverse_pressure_angle = 0.0;
    double reference_mm = 0.0, base_mm = 0.0, tip_mm = 0.0, root_mm = 0.0;  // diameters
};

GearCircles circles(const GearSpec& gear);

// Returns the smallest profile shift coefficient without undercut.
double min_shift(const GearSpec& gear);

// The involute function, tan(a) − a.
double involute(double angle);

// Half the angle that a tooth spans at a radius on its flanks.
double half_tooth_angle(const GearSpec& gear, double radius_mm);

// The rotation of the transverse section at a distance from the mid plane.
double twist(const GearSpec& gear, double distance_mm);

struct Point2 {
    double x = 0.0, y = 0.0;
};

// The counter-clockwise side (y > 0) of a gap in the mid plane, with the gap's middle on +x: first the fillet
// that the tool's rounded tip cuts, from the root circle to the flank, then the involute up to the tip
// circle.
struct FlankProfile {
    std::vector<Point2> fillet;
    std::vector<Point2> flank;
    std::vector<double> fillet_lengths, flank_lengths;  // arc length from the first point of each
    // Unit vectors along the profile, towards the tip.
    Point2 fillet_start_tangent, fillet_end_tangent, flank_end_tangent;
};

FlankProfile flank_profile(const GearSpec& gear, int fillet_points, int flank_points);

}  // namespace bolt::models::reducer
