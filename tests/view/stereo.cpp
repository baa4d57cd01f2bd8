// The disparity of stereo pictures.
#include "game/view/pictures.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "game/view/camera.hpp"

using namespace bolt;

TEST_CASE("Stereo: the disparity is zero at the target and follows the distance elsewhere") {
    view::Orbit orbit;
    orbit.target = Vec3(0.1, 0.2, 0.3);
    orbit.yaw = 0.7;
    orbit.pitch = 0.4;
    orbit.distance = 0.8;
    constexpr float aspect = 1.5F;
    const render::BoundingBox box{glm::vec3(-1.0F), glm::vec3(1.0F)};
    const auto eyes = view::eye_offsets(true);
    REQUIRE(eyes.size() == 2);
    CHECK(view::eye_offsets(false) == std::vector<float>{0.0F});
    const render::Eye left = view::eye_of(orbit, box, aspect, eyes[0]),
                      right = view::eye_of(orbit, box, aspect, eyes[1]);
    CHECK(glm::distance(left.position, right.position) == doctest::Approx(view::mean_eye_separation));
    const glm::vec3 middle = view::eye_of(orbit, box, aspect).position;
    const auto across = [&](const render::Eye& eye, const glm::vec3& point) {
        const glm::vec4 clip = eye.clip_from_world * glm::vec4(point, 1.0F);
        return glm::vec2(clip) / clip.w;
    };
    for (const float depth : {0.3F, 0.8F, 2.0F}) {
        const glm::vec3 point = middle + depth / 0.8F * (glm::vec3(orbit.target) - middle);
        const glm::vec2 apart = across(left, point) - across(right, point);
        const float half = std::tan(0.5F * static_cast<float>(orbit.fov));
        const float expected = view::mean_eye_separation * (1.0F / depth - 1.0F / 0.8F) / (half * aspect);
        CHECK(std::abs(apart.x - expected) < 1e-4F);
        CHECK(std::abs(apart.y) < 1e-5F);  // both eyes are equally high
    }
}

TEST_CASE("Stereo: side_by_side joins the rows of the pictures") {
    const render::Picture a{1, 2, {1, 1, 1, 1, 2, 2, 2, 2}};
    const render::Picture b{2, 2, {3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 6, 6, 6, 6}};
    const render::Picture both = view::side_by_side(std::vector{a, b});
    CHECK(both.width == 3);
    CHECK(both.height == 2);
    CHECK(both.rgba ==
          std::vector<std::uint8_t>{1, 1, 1, 1, 3, 3, 3, 3, 4, 4, 4, 4, 2, 2, 2, 2, 5, 5, 5, 5, 6, 6, 6, 6});
}
