// Tests of the gears against the closed formulas of ISO 21771: circles, involute flanks, and teeth that mesh
// without overlap.
#include "tools/assets/models/reducer/gear.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "tools/assets/models/reducer/layout.hpp"

namespace {

using namespace bolt::models::reducer;
constexpr double pi = std::numbers::pi;

struct GearPair {
    const GearSpec* pinion;
    const GearSpec* wheel;
    double centre_mm;
};
const GearPair pairs[] = {{&pinion_1, &wheel_1, 150.0}, {&pinion_2, &wheel_2, 200.0}};

// Half of a gap's outline as (radius, angle from the gap's middle), root to tip.
struct GapSide {
    std::vector<double> radius, angle;
    double root, tip;
};

GapSide gap_side(const GearSpec& gear) {
    const FlankProfile profile = flank_profile(gear, 400, 800);
    GapSide side;
    for (const auto* part : {&profile.fillet, &profile.flank})
        for (const Point2& p : *part) {
            const double radius = std::hypot(p.x, p.y);
            if (!side.radius.empty() && radius <= side.radius.back()) continue;
            side.radius.push_back(radius);
            side.angle.push_back(std::atan2(p.y, p.x));
        }
    side.root = circles(gear).root_mm / 2.0;
    side.tip = circles(gear).tip_mm / 2.0;
    return side;
}

// Half the gap's opening at a radius, as an angle; 0 below the root circle.
double opening(const GapSide& side, double radius) {
    const auto at = std::lower_bound(side.radius.begin(), side.radius.end(), radius);
    if (at == side.radius.begin()) return 0.0;
    if (at == side.radius.end()) return side.angle.back();
    const auto i = static_cast<std::size_t>(at - side.radius.begin());
    const double t = (radius - side.radius[i - 1]) / (side.radius[i] - side.radius[i - 1]);
    return side.angle[i - 1] + t * (side.angle[i] - side.angle[i - 1]);
}

// The smallest clearance (mm along the circle) between the teeth of `a`, turned by `turn_a` about the origin,
// and the left and right flanks of `b`, turned by `turn_b` about (centre, 0). Both angles are those of a
// gap's middle.
struct FlankClearance {
    double left = 1e9, right = 1e9;
};

FlankClearance flank_clearance(const GearSpec& a, double turn_a, const GearSpec& b, double turn_b,
                               double centre) {
    const GapSide side_a = gap_side(a), side_b = gap_side(b);
    const double pitch_a = 2.0 * pi / a.teeth, pitch_b = 2.0 * pi / b.teeth;
    FlankClearance least;
    for (int gap = -3; gap <= 3; ++gap) {
        for (std::size_t i = 0; i < side_a.radius.size(); ++i) {
            for (const double sign : {-1.0, 1.0}) {
                // The gap of a that is nearest to the centre line, and its neighbours.
                const double middle = turn_a + pitch_a * (gap - std::round(turn_a / pitch_a));
                const double angle = middle + sign * side_a.angle[i];
                const double x = side_a.radius[i] * std::cos(angle) - centre,
                             y = side_a.radius[i] * std::sin(angle);
                const double radius = std::hypot(x, y);
                if (radius >= side_b.tip) continue;
                if (radius <= side_b.root) return {-1.0, -1.0};
                const double phase =
                    std::remainder(std::atan2(y, x) - turn_b, pitch_b);  // from the gap's middle
                const double half = opening(side_b, radius);
                // The +angle side of a's gap is the lower flank of the tooth above it. About b's axis, which
                // is on the right, the lower side of a gap is at larger angles.
                if (sign > 0 || half < std::abs(phase))
                    least.right = std::min(least.right, (half - phase) * radius);
                if (sign < 0 || half < std::abs(phase))
                    least.left = std::min(least.left, (half + phase) * radius);
            }
        }
    }
    return least;
}

}  // namespace

TEST_CASE("Gears: reference, base, tip and root diameters follow ISO 21771") {
    for (const GearPair& pair : pairs)
        for (const GearSpec* gear : {pair.pinion, pair.wheel}) {
            const GearCircles c = circles(*gear);
            const double m = gear->module_mm * 1e-3, cos_beta = std::cos(gear->helix);
            // tan(alpha_t) = tan(20 deg) / cos(beta). cos is computed from tan, so that the test does not
            // repeat the code's formula.
            const double tan_t = std::tan(20.0 * pi / 180.0) / cos_beta;
            const double d = gear->teeth * m / cos_beta;
            CHECK(std::abs(c.reference_mm * 1e-3 - d) < 1e-6);
            CHECK(std::abs(c.base_mm * 1e-3 - d / std::sqrt(1.0 + tan_t * tan_t)) < 1e-6);
            CHECK(std::abs(c.tip_mm * 1e-3 - (d + 2.0 * m * (1.0 + gear->shift))) < 1e-6);
            CHECK(std::abs(c.root_mm * 1e-3 - (d - 2.0 * m * (1.25 - gear->shift))) < 1e-6);
        }
}

TEST_CASE("Gears: helix and modules give the centre distances at the reference pressure angle") {
    for (const GearPair& pair : pairs) {
        const double sum = (circles(*pair.pinion).reference_mm + circles(*pair.wheel).reference_mm) / 2.0;
        CHECK(std::abs(sum - pair.centre_mm) < 1e-3);
        CHECK(pair.pinion->shift + pair.wheel->shift == doctest::Approx(0.0));
        CHECK(pair.pinion->hand != pair.wheel->hand);
    }
    CHECK(shafts[1].x - shafts[0].x == 150.0);
    CHECK(shafts[2].x - shafts[1].x == 200.0);
    CHECK(wheel_1.hand == pinion_2.hand);  // axial forces of the intermediate shaft oppose each other
}

TEST_CASE("Gears: the pinions' profile shift prevents undercut and exceeds the minimum by less than 0.01") {
    for (const GearPair& pair : pairs) {
        CHECK(pair.pinion->shift >= min_shift(*pair.pinion));
        CHECK(pair.pinion->shift < min_shift(*pair.pinion) + 0.01);
        CHECK(pair.wheel->shift >= min_shift(*pair.wheel));
    }
}

TEST_CASE("Gears: flanks are involutes of the base circle and join the fillet without a step or a kink") {
    for (const GearPair& pair : pairs)
        for (const GearSpec* gear : {pair.pinion, pair.wheel}) {
            const double base = circles(*gear).base_mm / 2.0;
            const FlankProfile profile = flank_profile(*gear, 5, 60);
            double start = 0.0;
            for (std::size_t i = 0; i < profile.flank.size(); ++i) {
                const Point2 p = profile.flank[i];
                const double r = std::hypot(p.x, p.y);
                // The length of the taut string, sqrt(r^2 - rb^2), equals the unwound arc of the base circle.
                const double length = std::sqrt(r * r - base * base);
                const double touch = std::atan2(p.y, p.x) + std::atan2(length, base) - length / base;
                if (i == 0) start = touch;
                CHECK(std::abs(touch - start) * base < 1e-9);
            }
            const Point2 a = profile.fillet.back(), b = profile.flank.front();
            CHECK(std::hypot(a.x - b.x, a.y - b.y) < 1e-9);
            const double direction = std::atan2(b.y, b.x) + std::acos(base / std::hypot(b.x, b.y));
            CHECK(profile.fillet_end_tangent.x == doctest::Approx(std::cos(direction)).epsilon(1e-9));
            CHECK(profile.fillet_end_tangent.y == doctest::Approx(std::sin(direction)).epsilon(1e-9));
            const Point2 root = profile.fillet.front();
            CHECK(2.0 * std::hypot(root.x, root.y) == doctest::Approx(circles(*gear).root_mm).epsilon(1e-12));
        }
}

TEST_CASE("Gears: the teeth fill the pitch except for the backlash") {
    for (const GearPair& pair : pairs) {
        const double r1 = circles(*pair.pinion).reference_mm / 2.0,
                     r2 = circles(*pair.wheel).reference_mm / 2.0;
        const double teeth =
            2.0 * (half_tooth_angle(*pair.pinion, r1) * r1 + half_tooth_angle(*pair.wheel, r2) * r2);
        const double backlash = pi * circles(*pair.pinion).transverse_module_mm - teeth;
        CHECK(backlash == doctest::Approx(pair.pinion->thinning_mm + pair.wheel->thinning_mm).epsilon(1e-9));
        CHECK(backlash > 0.05);
        CHECK(backlash < 0.25);
    }
}

TEST_CASE("Gears: over a whole pitch no teeth overlap, and the clearance is the stated backlash") {
    for (const GearPair& pair : pairs) {
        const GearSpec &p = *pair.pinion, &w = *pair.wheel;
        const double ratio = static_cast<double>(p.teeth) / w.teeth;
        const double backlash = p.thinning_mm + w.thinning_mm;
        for (int step = 0; step < 24; ++step) {
            const double turn = 2.0 * pi / p.teeth * step / 24.0;
            // As in the model: a tooth of the pinion and a gap of the wheel are on the line of centres.
            const FlankClearance r =
                flank_clearance(p, pi / p.teeth + turn, w, pi - turn * ratio, pair.centre_mm);
            CAPTURE(p.teeth);
            CAPTURE(step);
            CHECK(r.left > 0.0);
            CHECK(r.right > 0.0);
            // Profiles are conjugate: the clearance does not depend on the rotation.
            CHECK(r.left + r.right == doctest::Approx(backlash).epsilon(0.1));
        }
    }
}

TEST_CASE("Gears: the mesh check finds a short centre distance and a wheel that is half a pitch off") {
    const double ratio = 14.0 / 85.0;
    const FlankClearance close = flank_clearance(pinion_1, pi / 14, wheel_1, pi, 149.7);
    CHECK(std::min(close.left, close.right) < 0.0);
    const FlankClearance off = flank_clearance(pinion_1, pi / 14, wheel_1, pi + pi / 85.0, 150.0);
    CHECK(std::min(off.left, off.right) < 0.0);
    const FlankClearance same_way =
        flank_clearance(pinion_1, pi / 14 + 0.1, wheel_1, pi + 0.1 * ratio, 150.0);
    CHECK(std::min(same_way.left, same_way.right) < 0.0);
}
