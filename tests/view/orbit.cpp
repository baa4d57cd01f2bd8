#include "game/view/camera.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "engine/base/random.hpp"

using namespace bolt;
using namespace bolt::view;

namespace {

const render::BoundingBox box{{-0.2F, -0.1F, -0.3F}, {0.4F, 0.3F, 0.1F}};

Orbit random_orbit(Random& random) {
    Orbit o;
    o.target = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)};
    o.yaw = random.uniform(-4, 4);
    o.pitch = random.uniform(-1.5, 1.5);
    o.distance = random.uniform(0.2, 3.0);
    o.fov = random.uniform(0.3, 1.2);
    return o;
}

// Projects a point onto a picture of aspect 1.6; in picture heights from the middle, y up.
glm::dvec2 projected(const Orbit& o, const Vec3& point) {
    const glm::vec4 clip = eye_of(o, box, 1.6F).clip_from_world * glm::vec4(glm::vec3(point), 1.0F);
    REQUIRE(clip.w > 0.0F);
    return {0.5 * 1.6 * static_cast<double>(clip.x / clip.w), -0.5 * static_cast<double>(clip.y / clip.w)};
}

// The point at the target's distance that projects to `at`.
Vec3 unprojected(const Orbit& o, const glm::dvec2& at) {
    const Vec3 eye(viewpoint_of(o).eye);
    const Vec3 back = glm::normalize(eye - o.target);
    const Vec3 right(std::cos(o.yaw), 0.0, -std::sin(o.yaw)), up = glm::cross(back, right);
    return o.target + 2.0 * o.distance * std::tan(0.5 * o.fov) * (at.x * right + at.y * up);
}

}  // namespace

TEST_CASE("Camera: viewpoints convert to orbits and back") {
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const Orbit o = random_orbit(random);
        const Viewpoint view = viewpoint_of(o);
        const Viewpoint again = viewpoint_of(orbit_of(view));
        CHECK(glm::distance(again.eye, view.eye) < 1e-5F);
        CHECK(again.target == view.target);
        CHECK(std::remainder(orbit_of(view).yaw - o.yaw, 2.0 * pi) == doctest::Approx(0.0).epsilon(1e-4));
    }
}

TEST_CASE("Camera: the eye of an orbit equals render::make_eye, and from straight above too") {
    for (const glm::vec3& eye :
         {glm::vec3(1, 0.5F, 2), {-1, -0.7F, -0.2F}, {0.1F, 3, 0.3F}, {0.1F, -3, 0.3F}}) {
        const Viewpoint view{"", eye, {0.1F, 0.0F, 0.3F}, 0.7F};
        const render::Eye direct = render::make_eye(
            view.eye, view.target, perspective_for(box, view.eye, view.target, view.fov, 1.6F));
        const render::Eye circled = eye_of(orbit_of(view), box, 1.6F);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                CHECK(circled.clip_from_world[column][row] ==
                      doctest::Approx(static_cast<double>(direct.clip_from_world[column][row]))
                          .epsilon(1e-4)
                          .scale(1.0));
    }
}

TEST_CASE("Camera: panning moves the point under the cursor with it") {
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        Orbit o = random_orbit(random);
        const glm::dvec2 from(random.uniform(-0.7, 0.7), random.uniform(-0.5, 0.5));
        const glm::dvec2 to(random.uniform(-0.7, 0.7), random.uniform(-0.5, 0.5));
        const Vec3 point = unprojected(o, from);
        CHECK(glm::distance(projected(o, point), from) < 1e-4);
        pan(o, to - from);
        CHECK(glm::distance(projected(o, point), to) < 1e-4);
    }
}

TEST_CASE(
    "Camera: zooming keeps the point under the cursor during the whole glide, and the distance is bounded") {
    Random random(7);
    for (int i = 0; i < 200; ++i) {
        CameraGlide camera;
        camera.jump(random_orbit(random));
        const glm::dvec2 at(random.uniform(-0.7, 0.7), random.uniform(-0.5, 0.5));
        const Vec3 point = unprojected(camera.shown, at);
        const double before = camera.shown.distance;
        zoom(camera.goal, 3.0, at, box);
        while (camera.advance(0.013)) CHECK(glm::distance(projected(camera.shown, point), at) < 2e-4);
        CHECK(camera.shown.distance == doctest::Approx(before * std::pow(0.88, 3.0)));
        zoom(camera.goal, -3.0, at, box);
        CHECK(camera.goal.distance == doctest::Approx(before));
    }
    Orbit o;
    zoom(o, 1e6, {0.1, 0.1}, box);
    CHECK(o.distance > 1e-4);
    zoom(o, -1e6, {0.1, 0.1}, box);
    CHECK(o.distance < 100.0);
    CHECK(std::isfinite(o.target.x));
}

TEST_CASE(
    "Camera: a picture height turns by half a turn, the pitch is bounded, the target stays in the middle") {
    Orbit o;
    o.target = {0.3, 0.2, 0.1};
    turn(o, {0.5, 0.0});
    CHECK(o.yaw == doctest::Approx(-0.5 * pi));
    turn(o, {0.0, -7.0});
    CHECK(o.pitch == doctest::Approx(0.5 * pi));
    CHECK(glm::length(projected(o, o.target)) < 1e-5);
    turn(o, {0.0, 7.0});
    CHECK(o.pitch == doctest::Approx(-0.5 * pi));
    CHECK(glm::length(projected(o, o.target)) < 1e-5);
    // The model follows the cursor: a point in front moves right with it.
    o = Orbit();
    const Vec3 front(0.0, 0.0, 0.2);
    turn(o, {0.05, 0.0});
    CHECK(projected(o, front).x > 0.01);
    o = Orbit();
    turn(o, {0.0, 0.05});
    CHECK(projected(o, front).y > 0.01);
}

TEST_CASE("Camera: fit_to_box shows every corner of the box from every direction, and fills the picture") {
    Random random(11);
    for (int i = 0; i < 100; ++i) {
        const Orbit o = fit_to_box(random_orbit(random), box, 1.6F);
        double most = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec2 at = projected(o, Vec3(box.corner(corner)));
            most = std::max({most, std::abs(at.x) / 0.8, std::abs(at.y) / 0.5});
        }
        CHECK(most <= 1.0);
        CHECK(most > 0.7);
    }
}

TEST_CASE(
    "Camera: the glide is independent of the frame times, ends exactly at its goal, and yaw takes the short "
    "way") {
    Random random(13);
    for (int i = 0; i < 50; ++i) {
        CameraGlide one, many;
        one.jump(random_orbit(random));
        one.goal = random_orbit(random);
        many = one;
        one.advance(0.12);
        for (const double part : {0.001, 0.039, 0.05, 0.03}) many.advance(part);
        CHECK(many.shown.yaw == doctest::Approx(one.shown.yaw));
        CHECK(many.shown.distance == doctest::Approx(one.shown.distance));
        CHECK(glm::distance(many.shown.target, one.shown.target) < 1e-9);
        int frames = 0;
        while (one.advance(1.0 / 60.0)) ++frames;
        CHECK(frames < 70);
        CHECK(one.shown.yaw == one.goal.yaw);
        CHECK(one.shown.target == one.goal.target);
        CHECK_FALSE(one.advance(1.0));
    }
    CameraGlide camera;
    camera.shown.yaw = camera.goal.yaw = 3.0 + 4.0 * pi;
    Orbit there;
    there.yaw = -3.0;
    camera.glide_to(there);
    CHECK(camera.goal.yaw - camera.shown.yaw == doctest::Approx(2.0 * pi - 6.0));
}
