// The resolution that keeps the frame rate of a headset or a window.
#include "game/view/resolution.hpp"

#include <doctest/doctest.h>

using namespace bolt::view;

namespace {

constexpr double period = 1.0 / 90.0;

// Frames of a GPU whose time grows with the number of pixels. Returns the number of changes.
int run(ResolutionControl& control, double full_time, int frames) {
    int changes = 0;
    for (int i = 0; i < frames; ++i) {
        const auto side = static_cast<double>(share_of(control));
        changes += update(control, {full_time * side * side, period, period}) ? 1 : 0;
    }
    return changes;
}

}  // namespace

TEST_CASE("Resolution: a fast GPU keeps all pixels, and one slow frame changes nothing") {
    ResolutionControl control;
    CHECK(run(control, 0.5 * period, 500) == 0);
    CHECK_FALSE(update(control, {3.0 * period, period, period}));
    CHECK(run(control, 0.5 * period, 100) == 0);
    CHECK(scaled(share_of(control), {2064, 2208}).width == 2064);
}

TEST_CASE("Resolution: a slow GPU gets at once as few pixels as it can draw in time, and keeps them") {
    for (const double factor : {1.0, 1.5, 2.0, 3.0, 5.0}) {
        CAPTURE(factor);
        ResolutionControl control;
        CHECK(run(control, factor * period, 3) == 1);
        const auto side = static_cast<double>(share_of(control));
        CHECK(factor * side * side <= 0.9);
        CHECK(run(control, factor * period, 2000) <= 1);  // one step up at most, no oscillation
        const VkExtent2D size = scaled(share_of(control), {2064, 2208});
        CHECK(size.width % 2 == 0);
        CHECK(size.width < 2064);
    }
}

TEST_CASE("Resolution: it returns when the GPU has time again, but not before a second") {
    ResolutionControl control;
    (void)run(control, 3.0 * period, 3);
    const int low = control.step;
    REQUIRE(low > 0);
    CHECK(run(control, 0.2 * period, 80) == 0);
    CHECK(run(control, 0.2 * period, 2000) == low);
    CHECK(control.step == 0);
}

TEST_CASE("Resolution: it is never below the last step, and unknown times change nothing") {
    ResolutionControl control;
    (void)run(control, 1000.0 * period, 10);
    CHECK(resolution_steps[control.step] == doctest::Approx(0.35));
    const int low = control.step;
    CHECK_FALSE(update(control, {0.0, period, period}));
    CHECK_FALSE(update(control, {0.01, 0.0, period}));
    CHECK(control.step == low);
    CHECK(scaled(share_of(control), {1, 1}).width == 1);
}

TEST_CASE("Resolution: a control with a coarsest step stops there") {
    ResolutionControl control;
    control.coarsest = 4;
    (void)run(control, 1000.0 * period, 10);
    CHECK(control.step == 4);
}

TEST_CASE("Resolution: lengths in pixels are scaled with the picture, lengths in metres are not") {
    bolt::render::Scene scene;
    scene.outline_px = 3.0F;
    scene.labels.resize(2);
    scene.labels[0].height = 16.0F;
    scene.labels[0].offset_px = {4.0F, -8.0F};
    scene.labels[1].placement = bolt::render::LabelPlacement::fixed;
    scene.labels[1].height = 0.02F;
    const bolt::render::Scene half = with_fewer_pixels(scene, 0.5F);
    CHECK(half.outline_px == 1.5F);
    CHECK(half.labels[0].height == 8.0F);
    CHECK(half.labels[0].offset_px == glm::vec2(2.0F, -4.0F));
    CHECK(half.labels[1].height == 0.02F);
}
