// Tests of bolts, nuts and washers: dimensions of the solids are compared with ISO 68-1, 724, 4014, 4032 and
// 7089.
#include "tools/assets/models/fasteners.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>

#include "engine/base/math.hpp"
#include "haptics/joint/fastener.hpp"
#include "support.hpp"
#include "tools/assets/models/solids.hpp"

using namespace bolt;
using namespace bolt::models;

namespace {

TopoDS_Shape made(Result<TopoDS_Shape> shape) {
    REQUIRE_MESSAGE(shape.has_value(), (shape ? "" : shape.error().message()));
    return *shape;
}

gp_Lin parallel_to_axis(double radius, double angle) {
    return {gp_Pnt(radius * std::cos(angle), radius * std::sin(angle), 0.0), gp::DZ()};
}

// Distances between consecutive crossings within z0 to z1. On a line at the pitch diameter all are P/2.
std::vector<double> spacings(const std::vector<double>& at, double z0, double z1) {
    std::vector<double> result;
    for (std::size_t i = 0; i + 1 < at.size(); ++i)
        if (at[i] > z0 && at[i + 1] < z1) result.push_back(at[i + 1] - at[i]);
    return result;
}

}  // namespace

TEST_CASE("Bolts: diameters, head and length are those of the tables") {
    struct {
        std::string size;
        double length;
    } const bolts[] = {{"M16", 180}, {"M16", 75}, {"M20", 80}, {"M8", 30}};
    for (const auto& [size, length] : bolts) {
        CAPTURE(size);
        CAPTURE(length);
        const auto table = joint::parse_thread(size);
        const auto spec = iso_4014(size, length);
        REQUIRE(spec);
        const TopoDS_Shape bolt = made(hex_bolt(*spec));
        CHECK(is_valid_solid(bolt));
        const double d = table->thread.d * 1e3, d2 = table->thread.d2 * 1e3, d3 = table->thread.d3 * 1e3;
        const double P = table->thread.pitch * 1e3;

        const auto found = radii(bolt);
        CHECK(has(found, 0.5 * d));   // shank and crests
        CHECK(has(found, 0.5 * d3));  // roots
        CHECK(has(found, 0.5 * table->size.head_bearing * 1e3));
        CHECK(found.size() == 3);
        CHECK(has(flat_to_flat(bolt), table->size.across_flats * 1e3));
        const Extent e = extent(bolt);
        CHECK(e.z0 == doctest::Approx(-table->size.head_height * 1e3).epsilon(1e-4));
        CHECK(e.z1 == doctest::Approx(length).epsilon(1e-4));

        const double full = length - joint::thread_length(d * 1e-3, length * 1e-3) * 1e3;
        for (const double angle : {0.3, 1.7, 3.9, 5.5}) {
            const auto cut =
                spacings(crossings(bolt, parallel_to_axis(0.5 * d2, angle)), full + 0.1, length - P);
            CHECK(cut.size() > 10);
            for (const double width : cut) CHECK(width == doctest::Approx(0.5 * P).epsilon(0.01));
        }
        // A right-handed thread climbs by P in a turn: a quarter turn shifts it by P/4.
        const auto here = crossings(bolt, parallel_to_axis(0.5 * d2, 0.3));
        const auto quarter_turn = crossings(bolt, parallel_to_axis(0.5 * d2, 0.3 + 0.5 * pi));
        for (const double z : here)
            if (z > full + P && z < length - 2.0 * P) CHECK(has(quarter_turn, z + 0.25 * P, 1e-3));
    }
}

TEST_CASE("Nuts: height and width are those of the tables, the bore exceeds the bolt by the allowance g") {
    for (const std::string size : {"M8", "M16", "M20"}) {
        CAPTURE(size);
        const auto table = joint::parse_thread(size);
        const TopoDS_Shape nut = made(hex_nut(*iso_4032(size)));
        CHECK(is_valid_solid(nut));
        const double d = table->thread.d * 1e3, P = table->thread.pitch * 1e3, g = 0.015 + 0.011 * P;
        const auto found = radii(nut);
        CHECK(found.size() == 2);
        CHECK(has(found, 0.5 * (d + g), 0.001));
        CHECK(has(found, 0.5 * (d - 1.08253 * P + g), 0.001));
        CHECK(has(flat_to_flat(nut), table->size.across_flats * 1e3));
        const Extent e = extent(nut);
        CHECK(std::abs(e.z0) < 0.01);
        CHECK(e.z1 == doctest::Approx(table->size.nut_height * 1e3).epsilon(1e-4));
        const double D2 = table->thread.d2 * 1e3 + g;
        const auto cut = spacings(crossings(nut, parallel_to_axis(0.5 * D2, 2.2)), 0.08 * d,
                                  table->size.nut_height * 1e3 - 0.08 * d);
        CHECK(cut.size() > 3);
        for (const double width : cut) CHECK(width == doctest::Approx(0.5 * P).epsilon(0.01));
    }
}

TEST_CASE("Washers: dimensions are those of ISO 7089") {
    const auto table = joint::parse_thread("M16");
    const TopoDS_Shape disc = made(washer(*iso_7089("M16")));
    CHECK(has(radii(disc), 0.5 * table->size.washer_inner * 1e3));
    CHECK(has(radii(disc), 0.5 * table->size.washer_outer * 1e3));
    CHECK(extent(disc).z1 == doctest::Approx(3.0));
}

TEST_CASE("Threads: a nut in phase does not overlap the bolt, a nut out of phase does") {
    for (const std::string size : {"M8", "M16"}) {
        CAPTURE(size);
        const auto spec = iso_4014(size, 40.0);
        const TopoDS_Shape bolt = made(hex_bolt(*spec));
        const TopoDS_Shape nut = made(hex_nut(*iso_4032(size)));
        const double dz = 40.0 - iso_4032(size)->height - 2.0 * spec->pitch;
        DepthInside depth_inside(bolt);
        const auto worst = [&](double turned_further) {
            const gp_Trsf seat =
                shift(0.0, 0.0, dz) * turn(gp::OZ(), nut_phase(dz, spec->pitch) + turned_further);
            double depth = 0.0;
            for (const gp_Pnt& p : surface_points(nut, 0.3, 61))
                if (std::hypot(p.X(), p.Y()) < 0.55 * spec->d)
                    depth = std::max(depth, depth_inside(p.Transformed(seat)));
            return depth;
        };
        CHECK(worst(0.0) < 1e-4);
        CHECK(worst(pi) > 0.1 * spec->pitch);
    }
}

TEST_CASE("Threads: a left-hand thread is the mirror image of a right-hand one, with the same head") {
    for (const std::string size : {"M8", "M16"}) {
        CAPTURE(size);
        auto spec = *iso_4014(size, 60.0);
        spec.grade = "8.8";
        auto nut_spec = *iso_4032(size);
        const TopoDS_Shape right = made(hex_bolt(spec)), right_nut = made(hex_nut(nut_spec));
        spec.direction = nut_spec.direction = ThreadDirection::left;
        const TopoDS_Shape left = made(hex_bolt(spec)), left_nut = made(hex_nut(nut_spec));
        CHECK(is_valid_solid(left));
        CHECK(is_valid_solid(left_nut));
        const double P = spec.pitch, r = 0.5 * spec.d - 0.3 * P, inside = 0.5 * spec.d - 0.25 * P;
        for (const double angle : {0.3, 1.7, 3.9, 5.5}) {
            const auto mirrored = [&](const TopoDS_Shape& a, const TopoDS_Shape& b, double radius) {
                const auto at = crossings(a, parallel_to_axis(radius, angle));
                const auto image = crossings(b, parallel_to_axis(radius, -angle));
                REQUIRE(at.size() == image.size());
                CHECK(at.size() > 8);
                for (std::size_t i = 0; i < at.size(); ++i)
                    CHECK(at[i] == doctest::Approx(image[i]).epsilon(1e-6));
            };
            mirrored(right, left, r);
            mirrored(right_nut, left_nut, inside);
        }
        // A left-handed thread falls by P in a turn: a quarter turn shifts it by -P/4.
        const auto here = crossings(left, parallel_to_axis(r, 0.3));
        const auto quarter_turn = crossings(left, parallel_to_axis(r, 0.3 + 0.5 * pi));
        for (const double z : here)
            if (z > spec.length - spec.thread_length + P && z < spec.length - 2.0 * P)
                CHECK(has(quarter_turn, z - 0.25 * P, 1e-3));
        // The class on the head is not mirrored.
        const double top = -spec.head_height;
        for (const double x : {-1.0, 0.4, 1.3})
            for (const double y : {-2.0, 0.1, 1.1}) {
                const gp_Lin line(gp_Pnt(x, y, top - 5.0), gp::DZ());
                CHECK(crossings(left, line).front() ==
                      doctest::Approx(crossings(right, line).front()).epsilon(1e-9));
            }
        // The pair meshes, and a nut of the other direction does not.
        DepthInside depth_inside(left);
        const double dz = 60.0 - nut_spec.height - 2.0 * P;
        const auto deepest = [&](const TopoDS_Shape& nut, ThreadDirection direction) {
            const gp_Trsf seat = shift(0.0, 0.0, dz) * turn(gp::OZ(), nut_phase(dz, P, direction));
            double depth = 0.0;
            for (const gp_Pnt& p : surface_points(nut, 0.3, 61))
                if (std::hypot(p.X(), p.Y()) < 0.55 * spec.d)
                    depth = std::max(depth, depth_inside(p.Transformed(seat)));
            return depth;
        };
        CHECK(deepest(left_nut, ThreadDirection::left) < 1e-4);
        CHECK(deepest(right_nut, ThreadDirection::right) > 0.1 * P);
    }
}

TEST_CASE("Threads: a mesh stays within its triangle budget") {
    CHECK(triangles(made(hex_bolt(*iso_4014("M16", 180.0))), 0.08, 0.4) <= 10000);
    CHECK(triangles(made(hex_nut(*iso_4032("M16"))), 0.08, 0.4) <= 4000);
}

TEST_CASE(
    "Fasteners: every size of the table becomes a valid bolt and nut, with helical and cosmetic threads") {
    for (const joint::FastenerSize& row : joint::fastener_sizes()) {
        CAPTURE(row.name);
        const std::string size(row.name);
        CHECK(hex_bolt(*iso_4014(size, 4.0 * row.d * 1e3)));
        CHECK(hex_nut(*iso_4032(size)));
        CHECK(hex_bolt(*iso_4014(size, 6.0 * row.d * 1e3), ThreadDetail::cosmetic));
        CHECK(hex_nut(*iso_4032(size), ThreadDetail::cosmetic));
        CHECK(washer(*iso_7089(size)));
    }
    CHECK(hex_bolt(*iso_4014("M16x1.5", 60.0)));
    for (const char* size : {"M5", "M6", "M8", "M10", "M12", "M16", "M20", "M24"})
        CHECK(socket_screw(*iso_4762(size, 4.0 * joint::parse_thread(size)->size.d * 1e3)));
    CHECK_FALSE(iso_4762("M4", 25.0));
    CHECK_FALSE(iso_4762("M30", 60.0));
    CHECK_FALSE(iso_4014("M17", 60.0));
}
