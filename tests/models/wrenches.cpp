// Tests of the wrenches: frame, fit of the jaw on the nut, and the forged shape.
#include <doctest/doctest.h>

#include <cmath>
#include <map>

#include "engine/base/math.hpp"
#include "support.hpp"
#include "tools/assets/models/solids.hpp"
#include "tools/assets/models/wrench.hpp"

using namespace bolt;
using namespace bolt::models;

namespace {

// Cached, because building a wrench takes seconds.
TopoDS_Shape cached_wrench(const WrenchSpec& spec) {
    static std::map<double, TopoDS_Shape> by_size;
    TopoDS_Shape& wrench = by_size[spec.size];
    if (!wrench.IsNull()) return wrench;
    const auto shape = open_end_wrench(spec);
    REQUIRE_MESSAGE(shape.has_value(), (shape ? "" : shape.error().message()));
    wrench = *shape;
    return wrench;
}

bool inside(const TopoDS_Shape& solid, double x, double y, double z) {
    return DepthInside(solid)(gp_Pnt(x, y, z)) > 0.0;
}

}  // namespace

TEST_CASE("Wrenches: the jaw fits the nut of its size at the head's angle") {
    struct {
        double size, grip;
    } const wrenches[] = {{13.0, 140.0}, {24.0, 230.0}, {30.0, 380.0}};
    for (const auto& [size, grip] : wrenches) {
        CAPTURE(size);
        const WrenchSpec spec = wrench_spec(size, grip);
        const TopoDS_Shape wrench = cached_wrench(spec);

        // Across the mouth's direction, the flats of the jaw are at ±jaw/2.
        const gp_Dir mouth(-std::cos(spec.head_angle), -std::sin(spec.head_angle), 0.0);
        const gp_Dir across = gp_Dir(gp_Vec(gp::DZ()).Crossed(gp_Vec(mouth)));
        double nearest = 1e9, farthest = -1e9;
        for (const double at : crossings(wrench, gp_Lin(gp_Pnt(0, 0, 0), across))) {
            if (at > 0.0)
                nearest = std::min(nearest, at);
            else
                farthest = std::max(farthest, at);
        }
        CHECK(nearest == doctest::Approx(0.5 * spec.jaw).epsilon(1e-5));
        CHECK(farthest == doctest::Approx(-0.5 * spec.jaw).epsilon(1e-5));
        // The mouth is open: a ray from the middle through it does not cross the wrench.
        for (const double at : crossings(wrench, gp_Lin(gp_Pnt(0, 0, 0), mouth))) CHECK(at < 0.0);

        // The nut's hexagon fits with two flats along the jaw, and overlaps when turned by 10°.
        DepthInside depth_inside(wrench);
        const auto worst = [&](double turned) {
            double depth = 0.0;
            for (int i = 0; i < 48; ++i) {
                const double angle = i * pi / 24.0, flat = std::remainder(angle, pi / 3.0);
                const double r = 0.5 * size / std::cos(flat),
                             at = angle + spec.head_angle + 0.5 * pi + turned;
                depth = std::max(depth, depth_inside(gp_Pnt(r * std::cos(at), r * std::sin(at), 0.5)));
            }
            return depth;
        };
        CHECK(worst(0.0) < 1e-6);
        CHECK(worst(pi / 18.0) > 0.3);
    }
}

TEST_CASE("Wrenches: the handle is waisted, hollowed on both sides and has rounded edges") {
    const WrenchSpec spec = wrench_spec(24.0, 230.0);
    const TopoDS_Shape wrench = cached_wrench(spec);
    const double z = 0.5 * spec.handle_thickness;
    const Extent e = extent(wrench);
    CHECK(std::abs(e.x1 - spec.end) < 1.0);
    CHECK(e.z1 == doctest::Approx(0.5 * spec.head_thickness).epsilon(1e-3));
    CHECK(e.z0 == doctest::Approx(-e.z1).epsilon(1e-3));
    for (const double x : {80.0, 150.0, 230.0}) {
        CAPTURE(x);
        double side = 0.0;
        for (const double at : crossings(wrench, gp_Lin(gp_Pnt(x, 0, 0), gp::DY())))
            side = std::max(side, at);
        CHECK(side > 0.4 * spec.handle_width);
        CHECK_FALSE(inside(wrench, x, side - 0.2, z - 0.2));  // the edge is rounded off
        CHECK(inside(wrench, x, side - 2.2, z - 0.2));        // the rim is solid
        CHECK(inside(wrench, x, side - 2.2, 0.2 - z));
    }
    // The hollows between the raised letters.
    CHECK_FALSE(inside(wrench, 170.0, 0.0, z - 0.3));
    CHECK_FALSE(inside(wrench, 170.0, 0.0, 0.3 - z));
    CHECK(inside(wrench, 170.0, 0.0, 0.0));
}
