// Tests of the teeth in the shipped file: their flanks lie on the involute helicoid, in the phase in which
// the pairs mesh.
#include <doctest/doctest.h>

#include <BRepAdaptor_Surface.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "shipped.hpp"
#include "tools/assets/models/reducer/layout.hpp"

namespace reducer_teeth_test {

namespace {

using namespace reducer_test;
using namespace bolt::models::reducer;
constexpr double pi = std::numbers::pi;

struct GearPlacement {
    const char* part;
    const GearSpec* gear;
    double x, y, turn;  // turn: angle of a gap's middle at mid width, seen from -Y
};
// On the line of centres a tooth of the pinion is in a gap of the wheel.
const GearPlacement all_gears[] = {
    {"shaft_input", &pinion_1, shafts[0].x, pair_1_y, pi / pinion_1.teeth},
    {"wheel_1", &wheel_1, shafts[1].x, pair_1_y, pi},
    {"shaft_intermediate", &pinion_2, shafts[1].x, pair_2_y, pi / pinion_2.teeth},
    {"wheel_2", &wheel_2, shafts[2].x, pair_2_y, pi}};

struct Deviation {
    double largest = 0.0;  // mm along the circle
    int points = 0, outside = 0;
};

Deviation deviation(const GearPlacement& placed, const GearSpec& gear) {
    const Point2 join = flank_profile(gear, 3, 3).fillet.back();
    const double low = std::hypot(join.x, join.y) + 0.01, tip = circles(gear).tip_mm / 2.0;
    const double pitch = 2.0 * pi / gear.teeth;
    Deviation d;
    for (TopExp_Explorer faces(part(placed.part), TopAbs_FACE); faces.More(); faces.Next()) {
        const BRepAdaptor_Surface s(TopoDS::Face(faces.Current()));
        if (s.GetType() != GeomAbs_BSplineSurface) continue;
        for (int i = 0; i <= 6; ++i)
            for (int k = 0; k <= 4; ++k) {
                const gp_Pnt p =
                    s.Value(s.FirstUParameter() + (s.LastUParameter() - s.FirstUParameter()) * i / 6.0,
                            s.FirstVParameter() + (s.LastVParameter() - s.FirstVParameter()) * k / 4.0);
                const double x = p.X() - placed.x, y = -p.Z(), r = std::hypot(x, y);
                if (r > tip + 1e-3) ++d.outside;
                if (r < low || r > tip - 0.01) continue;
                const double angle = std::atan2(y, x) - placed.turn - twist(gear, p.Y() - placed.y);
                const double phase = std::abs(std::remainder(angle, pitch));
                d.largest =
                    std::max(d.largest, std::abs(phase - (pi / gear.teeth - half_tooth_angle(gear, r))) * r);
                ++d.points;
            }
    }
    return d;
}

}  // namespace

TEST_CASE("Reducer teeth: flanks lie within a micrometre of their involute helicoids") {
    for (const GearPlacement& placed : all_gears) {
        CAPTURE(placed.part);
        const Deviation d = deviation(placed, *placed.gear);
        CHECK(d.points > 2 * placed.gear->teeth * 20);
        CHECK(d.outside == 0);
        CHECK(d.largest < 1e-3);
    }
}

TEST_CASE("Reducer teeth: the flank check finds the other hand and another profile shift") {
    GearSpec other = wheel_1;
    other.hand = HelixHand::left;
    CHECK(deviation(all_gears[1], other).largest > 0.1);
    other = wheel_1;
    other.shift += 0.01;
    CHECK(deviation(all_gears[1], other).largest > 0.005);
}

}  // namespace reducer_teeth_test
