// The disparity of stereo pictures.
#include "game/view/pictures.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "game/view/camera.hpp"
#include "game/view/immersive_frame.hpp"

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

TEST_CASE(
    "Stereo: the hidden area of a lens is at the same place of the picture as the corners of its view") {
    xr::HeadView view;
    const FieldOfView fov{-0.8, 0.7, 0.75, -0.85};
    const auto tangent = [](double angle) { return static_cast<float>(std::tan(angle)); };
    view.eyes = {{{}, fov, nullptr}, {{}, fov, nullptr}};
    view.eyes[1].hidden = std::make_shared<const xr::HiddenArea>(
        xr::HiddenArea{{tangent(fov.left), tangent(fov.up)},
                       {tangent(fov.right), tangent(fov.down)},
                       {0.5F * (tangent(fov.left) + tangent(fov.right)), tangent(fov.down)}});
    const view::EyeGroup group = view::eye_group(view, {64, 48});
    REQUIRE(group.eyes.size() == 2);
    CHECK(group.eyes[0].hidden == nullptr);
    REQUIRE(group.eyes[1].hidden != nullptr);
    const glm::vec2 expected[] = {{-1.0F, -1.0F}, {1.0F, 1.0F}, {0.0F, 1.0F}};
    REQUIRE(group.eyes[1].hidden->size() == 3);
    for (std::size_t i = 0; i < 3; ++i) CHECK(glm::distance((*group.eyes[1].hidden)[i], expected[i]) < 1e-5F);
    // The view of the eye itself puts a point at the first corner there, too.
    const glm::vec4 clip = group.eyes[1].clip_from_world *
                           glm::vec4(2.0F * tangent(fov.left), 2.0F * tangent(fov.up), -2.0F, 1.0F);
    CHECK(glm::distance(glm::vec2(clip) / clip.w, expected[0]) < 1e-5F);
}

TEST_CASE("Mirror: the window of a headset shows the chosen pictures, undistorted and not one over another") {
    using view::Mirror;
    constexpr VkExtent2D window{1280, 720};
    view::MirrorSources both;
    both.eyes = {{nullptr, 0}, {nullptr, 1}};
    both.eye_size = {1000, 1100};
    both.panel = render::ImageLayer{nullptr, 7};
    both.panel_size = {1740, 1140};
    const auto layers = [](const std::vector<gpu::ShownPicture>& pictures) {
        std::vector<std::uint32_t> shown;
        for (const gpu::ShownPicture& picture : pictures) shown.push_back(picture.layer);
        return shown;
    };
    const auto shown = [&](Mirror mirror) { return view::mirror_pictures(mirror, both, window); };
    using Layers = std::vector<std::uint32_t>;
    CHECK(layers(shown(Mirror::left_eye)) == Layers{0});
    CHECK(layers(shown(Mirror::right_eye)) == Layers{1});
    CHECK(layers(shown(Mirror::both_eyes)) == Layers{0, 1});
    CHECK(layers(shown(Mirror::panel)) == Layers{0, 7});
    for (std::size_t i = 0; i < view::mirror_count; ++i) {
        const auto pictures = shown(static_cast<Mirror>(i));
        std::int64_t right_end = 0;
        for (const gpu::ShownPicture& picture : pictures) {
            REQUIRE(picture.place);
            const VkRect2D part = picture.part.value_or(VkRect2D{{0, 0}, both.panel_size});
            const auto aspect = [](const VkRect2D& r) {
                return static_cast<double>(r.extent.width) / static_cast<double>(r.extent.height);
            };
            CHECK(aspect(part) == doctest::Approx(aspect(*picture.place)).epsilon(0.01));
            CHECK(picture.place->offset.x >= right_end);
            right_end = picture.place->offset.x + static_cast<std::int64_t>(picture.place->extent.width);
            CHECK(right_end <= window.width);
            CHECK(static_cast<std::uint32_t>(picture.place->offset.y) + picture.place->extent.height <=
                  window.height);
        }
    }
    // With one eye, and without a panel, the window shows the eye.
    view::MirrorSources one = both;
    one.eyes.pop_back();
    one.panel.reset();
    for (std::size_t i = 0; i < view::mirror_count; ++i)
        CHECK(layers(view::mirror_pictures(static_cast<Mirror>(i), one, window)) == Layers{0});
    CHECK(layers(view::mirror_pictures(Mirror::both_eyes, both, {1, 1})) == Layers{0});
}
