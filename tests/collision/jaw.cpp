// The jaw and the hexagon against closed-form results, for a 24.2 mm jaw and an M16 nut.
#include "haptics/collision/jaw.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "engine/base/random.hpp"
#include "tests/support/forbidden.hpp"

using namespace bolt;
using namespace bolt::collision;

namespace {

constexpr double opening = 24.2e-3, flats = 24e-3;

struct Pair {
    Jaw jaw = make_jaw(opening, to_radians(15.0), 12e-3);
    HexagonPrism prism{flats, 14.8e-3, 22.5e-3};
    JawParts parts = jaw_parts(jaw).value();
    Convex nut = hexagon(prism).value();

    // Pose of the wrench in the nut's frame. `at`: from the nut's middle to the jaw's (m). Rotations (rad)
    // apply in the order `pitch` (about the line across the flats), `tilt` (about the flats' length), `yaw`
    // (about the bolt).
    [[nodiscard]] Pose wrench(const Vec3& at = Vec3(0.0), double yaw = 0.0, double tilt = 0.0,
                              double pitch = 0.0) const {
        const Quat square_on = glm::angleAxis(-jaw.head_angle, Vec3(0, 0, 1));
        const Quat turn = glm::angleAxis(yaw, Vec3(0, 0, 1)) * glm::angleAxis(tilt, Vec3(1, 0, 0)) *
                          glm::angleAxis(pitch, Vec3(0, 1, 0));
        return {at + Vec3(0, 0, 0.5 * prism.height), turn * square_on};
    }
    [[nodiscard]] GripSolids solids() const { return {parts, {&nut, 1}}; }
    [[nodiscard]] double apart(const Pose& wrench) const {
        double least = 1.0;
        for (const Convex& part : parts) least = std::min(least, separation(part, nut, wrench, 0.1).distance);
        return least;
    }
};

double along(const Convex& tool, const Convex& obstacle, const Pose& pose, const Vec3& n) {
    double least = 1.0, most = -1.0;
    for (const Vec3& p : tool.points) least = std::min(least, glm::dot(pose * p, n));
    for (const Vec3& p : obstacle.points) most = std::max(most, glm::dot(p, n));
    return least - most;
}

// rad; solves cos ψ + sin ψ/√3 = w/s, where a corner of the hexagon touches each flat of the jaw.
double play_of(double w, double s) { return pi / 6.0 - std::acos(0.5 * std::sqrt(3.0) * w / s); }

Vec3 any_direction(Random& random) {
    return glm::normalize(Vec3(random.normal(), random.normal(), random.normal()) + Vec3(1e-9, 0, 0));
}

}  // namespace

TEST_CASE("Jaw: the solids satisfy Euler's formula and the nut has its chamfer") {
    const Pair p;
    // Euler: corners − edges + faces = 2.
    for (const Convex* solid : {&p.parts[0], &p.parts[1], &p.parts[2], &p.nut}) {
        CHECK(solid->edges.size() <= max_edges);
        CHECK(solid->faces.size() <= 64);
        CHECK(solid->points.size() <= 64);
        CHECK(solid->points.size() + solid->faces.size() == solid->edges.size() + 2);
    }
    // The ends of the prism have twelve sides. The chamfer cone cuts the flats, lowest at the corners.
    double highest_corner = 0.0;
    for (const Vec3& q : p.nut.points)
        if (std::hypot(q.x, q.y) > flats / std::sqrt(3.0) - 1e-9)
            highest_corner = std::max(highest_corner, q.z);
    CHECK(highest_corner == doctest::Approx(p.prism.height - p.prism.corner_drop()).epsilon(1e-9));
    CHECK(p.prism.corner_drop() == doctest::Approx((13.856e-3 - 11.25e-3) * std::tan(pi / 6)).epsilon(1e-3));
}

TEST_CASE("Jaw: a centred jaw has half the clearance on each flat and the full clearance at the throat") {
    const Pair p;
    CHECK(separation(p.parts[0], p.nut, p.wrench(), 0.1).distance == doctest::Approx(0.1e-3).epsilon(1e-9));
    CHECK(separation(p.parts[1], p.nut, p.wrench(), 0.1).distance == doctest::Approx(0.1e-3).epsilon(1e-9));
    CHECK(separation(p.parts[2], p.nut, p.wrench(), 0.1).distance ==
          doctest::Approx(p.jaw.depth - flats / std::sqrt(3.0)).epsilon(1e-9));
    const Pose aside = p.wrench({0, 0.06e-3, 0});
    CHECK(separation(p.parts[0], p.nut, aside, 0.1).distance == doctest::Approx(0.16e-3).epsilon(1e-9));
    CHECK(separation(p.parts[1], p.nut, aside, 0.1).distance == doctest::Approx(0.04e-3).epsilon(1e-9));
    CHECK(p.apart(p.wrench({0, 0.12e-3, 0})) == doctest::Approx(-0.02e-3).epsilon(1e-9));
}

TEST_CASE("Jaw: the backlash to either side equals the closed form, every 60 degrees") {
    const Pair p;
    const double play = play_of(opening, flats);
    CHECK(to_degrees(play) == doctest::Approx(0.8376).epsilon(1e-4));
    for (int sixth = 0; sixth < 6; ++sixth)
        for (const double side : {-1.0, 1.0}) {
            const double yaw = sixth * pi / 3.0 + side * play;
            CHECK(std::abs(p.apart(p.wrench(Vec3(0.0), yaw))) < 1e-9);
            CHECK(p.apart(p.wrench(Vec3(0.0), yaw - side * 1e-4)) > 0.0);
            CHECK(p.apart(p.wrench(Vec3(0.0), yaw + side * 1e-4)) < 0.0);
        }
}

TEST_CASE("Jaw: the tilt is limited where the flats' edges meet both planes: w/2 cos - h sin = s/2") {
    const Pair p;
    const double w = 0.5 * opening, h = p.jaw.half_flat();
    const double most = std::acos(0.5 * flats / std::hypot(w, h)) - std::atan2(h, w);
    CHECK(to_degrees(most) == doctest::Approx(1.08).epsilon(0.05));
    for (const double side : {-1.0, 1.0}) {
        CHECK(std::abs(p.apart(p.wrench(Vec3(0.0), 0.0, side * most))) < 1e-9);
        CHECK(p.apart(p.wrench(Vec3(0.0), 0.0, side * (most - 1e-4))) > 0.0);
        CHECK(p.apart(p.wrench(Vec3(0.0), 0.0, side * (most + 1e-4))) < 0.0);
    }
    // The open end is free to rotate about the line across the flats.
    CHECK(p.apart(p.wrench({2e-3, 0, 0}, 0.0, 0.0, to_radians(10.0))) ==
          doctest::Approx(0.1e-3).epsilon(1e-6));
    // At half the backlash the jaw can tilt less: one of its edges meets a corner of the nut.
    CHECK(p.apart(p.wrench(Vec3(0.0), 0.5 * play_of(opening, flats), 0.6 * most)) < 0.0);
}

TEST_CASE("Jaw: no direction separates solids that overlap, and the separation is exact along its normal") {
    const Pair p;
    Random random(5);
    double worst_own = 0.0;
    int together = 0, apart = 0;
    for (int i = 0; i < 3000; ++i) {
        const double far = i % 3 == 0 ? 30e-3 : 1e-3;
        const Pose pose =
            p.wrench(far * Vec3(random.normal(), random.normal(), random.normal()), random.uniform(-0.6, 0.6),
                     random.uniform(-0.4, 0.4) * (i % 2), random.uniform(-0.4, 0.4) * (i % 5 == 0 ? 1 : 0));
        for (const Convex& part : p.parts) {
            const Separation s = separation(part, p.nut, pose, 1.0);
            worst_own = std::max(worst_own, std::abs(along(part, p.nut, pose, s.normal) - s.distance));
            if (s.distance > 0.0) {
                ++apart;
                continue;
            }
            ++together;
            for (int k = 0; k < 60; ++k) {
                const Vec3 near = s.normal + 1e-3 * k * k / 900.0 * any_direction(random);
                const Vec3 n = k < 30 ? any_direction(random) : glm::normalize(near);
                REQUIRE(along(part, p.nut, pose, n) <= 1e-12);
            }
        }
    }
    CHECK(worst_own < 1e-12);
    CHECK(together > 500);
    CHECK(apart > 500);
}

TEST_CASE("Jaw: the penetration depth is minimal among directions near its normal") {
    const Pair p;
    Random random(6);
    int touching = 0;
    for (int i = 0; i < 2000; ++i) {
        const Pose pose = p.wrench(0.4e-3 * Vec3(random.normal(), random.normal(), 10.0 * random.normal()),
                                   random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05));
        for (const Convex& part : p.parts) {
            const Separation s = separation(part, p.nut, pose, 1.0);
            if (s.distance > 0.0) continue;
            ++touching;
            for (int k = 0; k < 200; ++k) {
                const Vec3 n = glm::normalize(s.normal + 0.02 * k / 200.0 * any_direction(random));
                REQUIRE(along(part, p.nut, pose, n) <= s.distance + 1e-12);
            }
        }
    }
    CHECK(touching > 300);
}

TEST_CASE("Jaw: two flats meet in four contacts, and remove_axial_moment frees the rotation about the axis") {
    const Pair p;
    const Pose pose = p.wrench({0, 0.1e-3, 0});
    std::array<Contact, max_grip_contacts> found;
    const std::size_t count = solid_contacts(p.solids(), pose, {}, 0.15e-3, ObstacleId::nut(7), found);
    REQUIRE(count == 4);  // one flat only: the other is 0.2 mm away
    for (std::size_t i = 0; i < count; ++i) {
        const Contact& c = found[i];
        CHECK(std::abs(c.distance) < 1e-12);
        CHECK(c.obstacle == ObstacleId::nut(7));
        CHECK(glm::length(c.normal - Vec3(0, -1, 0)) < 1e-9);
        CHECK(std::abs(c.on_tool.x) == doctest::Approx(flats / std::sqrt(12.0)).epsilon(1e-6));
        CHECK(std::abs(c.on_tool.z - 7.4e-3) == doctest::Approx(p.jaw.half_flat()).epsilon(1e-6));
        CHECK(glm::length(c.on_obstacle + c.distance * c.normal - c.on_tool) < 1e-12);
    }
    remove_axial_moment(Vec3(0.0), Vec3(0, 0, 1), std::span(found).first(count));
    for (std::size_t i = 0; i < count; ++i) {
        CHECK(std::abs(glm::cross(found[i].on_tool, found[i].normal).z) < 1e-12);
        CHECK(std::abs(found[i].on_tool.z - 7.4e-3) == doctest::Approx(p.jaw.half_flat()).epsilon(1e-6));
    }
}

TEST_CASE("Jaw: the nearest contact is at the separation, and normals are unit vectors") {
    const Pair p;
    Random random(8);
    for (int i = 0; i < 2000; ++i) {
        const Pose nut{{0.1, 0.2, -0.3}, glm::normalize(Quat(0.8, 0.1, -0.5, 0.3))};
        const Pose pose =
            p.wrench(Vec3(random.normal() * 0.3e-3, random.normal() * 0.1e-3, random.normal() * 5e-3),
                     random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02));
        std::array<Contact, max_grip_contacts> found;
        const std::size_t count = solid_contacts(p.solids(), nut * pose, nut, 2e-3, {}, found);
        const double apart = p.apart(pose);
        double nearest = 1.0;
        for (std::size_t k = 0; k < count; ++k) {
            nearest = std::min(nearest, found[k].distance);
            REQUIRE(std::abs(glm::length(found[k].normal) - 1.0) < 1e-9);
        }
        if (apart < 2e-3) REQUIRE(nearest == doctest::Approx(apart).epsilon(1e-6).scale(1e-6));
        if (apart > 2e-3) REQUIRE(count == 0);
    }
}

TEST_CASE("Jaw: the fit of a turned, raised, pulled-back, tilted or flipped jaw") {
    const Pair p;
    const double side = flats / std::sqrt(12.0), flat = 2.0 * p.jaw.half_flat();
    HeadFit fit = jaw_fit(p.jaw, p.prism, p.wrench());
    CHECK(fit.overlap == doctest::Approx(flat).epsilon(1e-12));
    CHECK(fit.toward_mouth == doctest::Approx(side).epsilon(1e-12));
    CHECK(fit.toward_throat == doctest::Approx(side).epsilon(1e-12));
    CHECK(std::abs(fit.misalignment) < 1e-12);
    CHECK(fit.surrounds(opening));
    // Lifted so that half the height of its flats overlaps the flats of the nut.
    const double corner_top = 0.5 * p.prism.height - p.prism.corner_drop();
    fit = jaw_fit(p.jaw, p.prism, p.wrench({0, 0, corner_top}));
    CHECK(fit.overlap == doctest::Approx(0.5 * flat).epsilon(1e-12));
    CHECK_FALSE(jaw_fit(p.jaw, p.prism, p.wrench({0, 0, corner_top + p.jaw.half_flat()})).surrounds(opening));
    // Pulled towards the handle until only half of the flats' length is in contact, and then off the nut.
    fit = jaw_fit(p.jaw, p.prism, p.wrench({p.jaw.tip - p.jaw.lead_in, 0, 0}));
    CHECK(std::abs(fit.toward_mouth) < 1e-12);
    CHECK(fit.surrounds(opening));
    CHECK_FALSE(jaw_fit(p.jaw, p.prism, p.wrench({p.jaw.tip + side, 0, 0})).surrounds(opening));
    // Tightening is clockwise seen from outside. The fit repeats every sixth of a turn.
    for (const double yaw : {0.01, 0.01 - pi / 3.0, 0.01 + pi})
        CHECK(jaw_fit(p.jaw, p.prism, p.wrench(Vec3(0.0), yaw)).misalignment ==
              doctest::Approx(-0.01).epsilon(1e-9));
    fit = jaw_fit(p.jaw, p.prism, p.wrench({0, 0.05e-3, 0}, 0.0, 0.01));
    CHECK(fit.tilt == doctest::Approx(0.01).epsilon(1e-9));
    CHECK(fit.lateral_offset == doctest::Approx(-0.05e-3).epsilon(1e-3));
    // Flipped, with the head to the other side.
    Pose over = p.wrench();
    over.orientation = glm::angleAxis(pi, Vec3(1, 0, 0)) * over.orientation;
    fit = jaw_fit(p.jaw, p.prism, over);
    CHECK(fit.overlap == doctest::Approx(flat).epsilon(1e-12));
    CHECK(std::abs(fit.misalignment) < 1e-9);
    CHECK(p.apart(over) == doctest::Approx(0.1e-3).epsilon(1e-6));
}

TEST_CASE("Jaw: the contact query makes no forbidden call and repeats to the same bits") {
    const Pair p;
    std::array<Contact, max_grip_contacts> first, second;
    std::size_t count = 0, again = 0;
    const Pose pose = p.wrench({0, 0.05e-3, 6e-3}, 0.005, 0.003);
    const test::Forbidden in_search = test::forbidden_in([&] {
        count = solid_contacts(p.solids(), pose, {}, 1e-3, {}, first);
        again = solid_contacts(p.solids(), pose, {}, 1e-3, {}, second);
    });
    CHECK(in_search.all() == 0);
    REQUIRE(count == again);
    REQUIRE(count > 0);
    for (std::size_t i = 0; i < count; ++i) {
        CHECK(first[i].distance == second[i].distance);
        CHECK(first[i].on_tool == second[i].on_tool);
    }
}

TEST_CASE("Convex: a solid with more corners than fit is an error") {
    const auto prism_of = [](int sides) {
        std::vector<HalfSpace> planes{{{0, 0, 1}, 0.01}, {{0, 0, -1}, 0.01}};
        for (int i = 0; i < sides; ++i) {
            const double angle = 2.0 * pi * i / sides;
            planes.push_back({{std::cos(angle), std::sin(angle), 0.0}, 0.02});
        }
        return make_convex(planes);
    };
    const Result<Convex> largest = prism_of(32);
    REQUIRE(largest);
    CHECK(largest->points.size() == max_convex_points);
    const Result<Convex> refused = prism_of(33);
    REQUIRE(!refused);
    CHECK(refused.error().message() ==
          "a convex solid has 66 corners and 35 faces; expected at most 64 of each");
}
