#include <doctest/doctest.h>

#include <cmath>

#include "engine/base/random.hpp"
#include "game/view/camera.hpp"

using namespace bolt;
using namespace bolt::view;

TEST_CASE("Camera: limit_eye_height lowers the eye and keeps yaw, distance and target") {
    Random random(3);
    int lower = 0;
    for (int i = 0; i < 2000; ++i) {
        Orbit orbit;
        orbit.target = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
        orbit.yaw = random.uniform(-3, 3);
        orbit.pitch = random.uniform(0.1, 1.5);
        orbit.distance = random.uniform(0.2, 3.0);
        const double eye = random.uniform(-1.0, 3.0);
        const Orbit seated = limit_eye_height(orbit, eye);
        const double before = orbit.target.y + orbit.distance * std::sin(orbit.pitch);
        const double now = viewpoint_of(seated).eye.y;
        const double least = orbit.target.y + orbit.distance * std::sin(to_radians(5.0));
        CHECK(now == doctest::Approx(std::min(before, std::max(eye, least))).epsilon(1e-5));
        CHECK(seated.yaw == orbit.yaw);
        CHECK(seated.distance == orbit.distance);
        CHECK(seated.target == orbit.target);
        lower += now < before - 1e-6 ? 1 : 0;
    }
    CHECK(lower > 200);
}
