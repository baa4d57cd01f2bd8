#include <doctest/doctest.h>

#include <initializer_list>

#include "engine/base/math.hpp"
#include "engine/base/random.hpp"
#include "haptics/force/guide.hpp"

using namespace bolt;
using namespace bolt::force;

TEST_CASE("Guiding law: k/d outside d_min, K d inside, continuous, at most the root of k K") {
    const GuidingParameters g{0.02, 800.0, 0.5, 10.0};
    const double d_min = std::sqrt(0.02 / 800.0);
    const auto at = [&](double d) { return guiding_force(g, Vec3(d, 0, 0), Vec3(0.0)).x; };
    CHECK(at(0.1) == doctest::Approx(-0.2));
    CHECK(at(0.5 * d_min) == doctest::Approx(-800.0 * 0.5 * d_min));
    CHECK(at(d_min * (1 - 1e-9)) == doctest::Approx(at(d_min * (1 + 1e-9))));
    CHECK(at(0.0) == 0.0);
    for (double d = 1e-6; d < 2.0; d *= 1.01) {
        CHECK(std::abs(at(d)) <= std::sqrt(0.02 * 800.0) * (1 + 1e-12));
        CHECK(at(d) <= 0.0);
    }
    CHECK(at(1.0) == 0.0);  // beyond the range of the guide
}

TEST_CASE("Guiding law: the cap joins spring and hyperbola") {
    const GuidingParameters g{0.1, 500.0, 1.0, 3.0};
    CHECK(guiding_pull(g, 0.003) == doctest::Approx(1.5));
    CHECK(guiding_pull(g, 0.006) == doctest::Approx(3.0));
    CHECK(guiding_pull(g, 0.02) == 3.0);
    CHECK(guiding_pull(g, 0.1 / 3.0) == doctest::Approx(3.0));
    CHECK(guiding_pull(g, 0.1) == doctest::Approx(1.0));
}

TEST_CASE("Guiding law: the pull is the slope of the potential") {
    for (const double cap : {10.0, 3.0}) {
        const GuidingParameters g{0.02, 800.0, 0.5, cap};
        CHECK(guiding_potential(g, 0.0) == 0.0);
        for (double d = 1e-4; d < 1.5; d *= 1.05) {
            CAPTURE(d);
            const double h = 1e-6 * d;
            const double slope = (guiding_potential(g, d + h) - guiding_potential(g, d - h)) / (2 * h);
            CHECK(slope == doctest::Approx(guiding_pull(g, d)).epsilon(1e-4));
        }
        CHECK(guiding_potential(g, 7.0) == guiding_potential(g, 1.0));
    }
}

namespace {

Vec3 any_direction(Random& random) {
    return glm::normalize(Vec3(random.normal(), random.normal(), random.normal() + 1e-6));
}

Hexagon any_hexagon(Random& random) {
    Hexagon h;
    h.axis = any_direction(random);
    h.flat = glm::normalize(glm::cross(h.axis, any_direction(random)));
    h.across = glm::cross(h.axis, h.flat);
    return h;
}

}  // namespace

TEST_CASE("Guiding law: the aligning torque is the slope of its potential in every orientation") {
    Random random(6);
    for (int i = 0; i < 200; ++i) {
        const Hexagon hexagon = any_hexagon(random);
        const Vec3 normal = any_direction(random);
        const Vec3 jaw = glm::normalize(glm::cross(normal, any_direction(random)));
        const Vec3 torque = aligning_torque(0.2, hexagon, jaw, normal);
        for (int k = 0; k < 3; ++k) {
            Vec3 turn(0.0);
            turn[k] = 1e-6;
            const Quat there = rotation(turn), back = rotation(-turn);
            const double slope = (aligning_potential(0.2, hexagon, there * jaw, there * normal) -
                                  aligning_potential(0.2, hexagon, back * jaw, back * normal)) /
                                 2e-6;
            REQUIRE(torque[k] == doctest::Approx(-slope).epsilon(1e-5).scale(0.1));
        }
        REQUIRE(glm::length(torque) <= 2.0 * 0.2);
    }
}

TEST_CASE(
    "Guiding law: a jaw turns to the nearest of six flats, with 6 N m/rad per N m of the largest torque") {
    const Hexagon h;  // axis y, flats along x
    for (const double side : {1.0, -1.0}) {
        const Vec3 normal = side * h.axis;
        for (int flat = 0; flat < 6; ++flat) {
            for (const double off : {-25.0, -10.0, -1.0, 0.0, 1.0, 10.0, 25.0}) {
                const Quat turned = glm::angleAxis(to_radians(60.0 * flat + off), h.axis);
                const Vec3 torque = aligning_torque(0.2, h, turned * h.flat, normal);
                CHECK(torque.y ==
                      doctest::Approx(-0.2 * std::sin(6.0 * to_radians(off))).scale(1.0).epsilon(1e-9));
                CHECK(std::hypot(torque.x, torque.z) < 1e-12);
            }
        }
    }
}

TEST_CASE("Guiding law: a tilted tool is squared by the shorter rotation") {
    const Hexagon h;
    const auto tilt = [&](double degrees) {
        const Quat q = glm::angleAxis(to_radians(degrees), h.flat);
        return aligning_torque(0.2, h, h.flat, q * h.axis).x;
    };
    for (const double degrees : {10.0, 45.0, 80.0}) {
        CHECK(tilt(degrees) < 0.0);
        CHECK(tilt(-degrees) == doctest::Approx(-tilt(degrees)));
        CHECK(tilt(180.0 - degrees) == doctest::Approx(-tilt(degrees)));
    }
    CHECK(std::abs(tilt(90.0)) < 1e-12);
    CHECK(std::abs(tilt(0.0)) < 1e-12);
}

TEST_CASE("Guiding law: the torque is continuous where the nearest flat or side changes") {
    const Hexagon h;
    Vec3 last(0.0);
    for (int i = 0; i <= 36'000; ++i) {
        const Quat q = glm::angleAxis(to_radians(0.01 * i), glm::normalize(Vec3(1, 2, 3)));
        const Vec3 torque = aligning_torque(0.2, h, q * h.flat, q * h.axis);
        if (i > 0) REQUIRE(glm::length(torque - last) < 10.0 * 0.2 * to_radians(0.01));
        last = torque;
    }
}
