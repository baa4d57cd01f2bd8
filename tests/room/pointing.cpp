// The hands that a user sees while they point at the panel, and the buttons that the panel names.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>

#include "engine/xr/controller_profiles.hpp"
#include "tests/room/immersive_driver.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

AppOptions tracked(bool menu) {
    AppOptions options = test::options("first-nut", menu);
    options.choice.equipment.hand = HandMode::tracked;
    return options;
}

// The hand stands below the panel and points at its middle.
void show_hand(HeadlessTrainer& trainer, xr::Side side, bool points) {
    const Pose panel = *trainer.app().room()->panel;
    xr::HandInput& hand = trainer.immersive->hands[side];
    hand.active = true;
    const Vec3 at = panel * Vec3(side == xr::Side::right ? 0.2 : -0.2, -0.45, 0.35);
    hand.grip = xr::ReportedPose{{at, rotation({0.5, 0.0, 0.0})}, true};
    const Vec3 along = glm::normalize(panel.position - at) * (points ? 1.0 : -1.0);
    const double yaw = std::atan2(-along.x, -along.z),
                 pitch = std::atan2(along.y, std::hypot(along.x, along.z));
    hand.aim = xr::ReportedPose{
        {at, glm::angleAxis(yaw, Vec3(0.0, 1.0, 0.0)) * glm::angleAxis(pitch, Vec3(1.0, 0.0, 0.0))}, true};
}

std::size_t changed_pixels(const render::Picture& a, const render::Picture& b) {
    REQUIRE(a.rgba.size() == b.rgba.size());
    std::size_t changed = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        int most = 0;
        for (std::size_t c = 0; c < 3; ++c)
            most = std::max(most, std::abs(int{a.rgba[i + c]} - int{b.rgba[i + c]}));
        changed += most > 24 ? 1U : 0U;
    }
    return changed;
}

bool has_widget(const HeadlessTrainer& trainer, words::TextKey label) {
    const auto widgets = trainer.app().drawn_widgets();
    return std::any_of(widgets.begin(), widgets.end(),
                       [&](const DrawnWidget& widget) { return widget.label == label; });
}

}  // namespace

TEST_CASE("Pointing: the menu shows the hands, and a ray from the one that points at the panel") {
    const VkExtent2D size{320, 300};
    HeadlessTrainer driver(
        tracked(true), {std::getenv("BOLT_ROOM_PICTURES") != nullptr ? test::eye_size() : size, 0.3F, 0.02});
    driver.draw_interval = 1;
    driver.immersive = test::standing_user(size);
    if (std::getenv("BOLT_ROOM_PICTURES") != nullptr)
        driver.immersive = test::standing_user(test::eye_size());
    for (int i = 0; i < 40; ++i) driver.frame();
    const render::Picture without = driver.room_picture(0);
    show_hand(driver, xr::Side::left, false);
    driver.frame();
    const render::Picture with_left = driver.room_picture(0);
    constexpr std::size_t a_hand = 150;  // pixels of a hand at half a metre, at least
    CHECK(changed_pixels(without, with_left) > a_hand);
    show_hand(driver, xr::Side::right, true);
    driver.frame();
    test::save_eyes(driver, "menu-hands");
    CHECK(driver.app().room()->pointer.side == xr::Side::right);
    CHECK(changed_pixels(with_left, driver.room_picture(0)) > a_hand);
}

TEST_CASE(
    "Pointing: a lesson shows the other hand while it points at the panel, and no ray of the hand at work") {
    HeadlessTrainer driver(tracked(false), {test::eye_size(), 0.3F, 0.02});
    driver.draw_interval = 1;
    driver.immersive = test::standing_user(test::eye_size());
    driver.frame();
    driver.frame();
    const auto shown_objects = [&](bool left, bool points) {
        driver.immersive->hands = {};
        if (left) show_hand(driver, xr::Side::left, points);
        driver.frame();
        render::Scene scene;
        add_room_hands(scene, *driver.app().room_hands(), driver.immersive->hands, *driver.app().room(), {},
                       {false, xr::Side::right});
        return scene.objects.size();
    };
    CHECK(shown_objects(false, false) == 0);
    CHECK(shown_objects(true, false) == 0);
    CHECK(shown_objects(true, true) >= 2);  // hand and ray
    driver.frame();
    test::save_eyes(driver, "lesson-pointing");
}

TEST_CASE("Pointing: the panel of a lesson names the buttons of the controller") {
    HeadlessTrainer driver(tracked(false), {test::eye_size(), 0.3F, 0.02});
    driver.draw_interval = 1;
    driver.immersive = test::standing_user(test::eye_size());
    xr::HandInput& right = driver.immersive->hands[xr::Side::right];
    right.active = true;
    const auto controls_of = [&](const xr::ControllerProfile* controller) {
        right.controller = controller;
        driver.frame();
        driver.frame();
    };
    controls_of(nullptr);
    CHECK(has_widget(driver, "room.controls.hands"));
    const words::TextKey texts[] = {"room.controls.simple", "room.controls.touch",  "room.controls.index",
                                    "room.controls.vive",   "room.controls.motion", "room.controls.hands"};
    const auto profiles = xr::controller_profiles();
    REQUIRE(profiles.size() == std::size(texts));
    for (std::size_t i = 0; i < profiles.size(); ++i) {
        CAPTURE(profiles[i].path);
        controls_of(&profiles[i]);
        CHECK(has_widget(driver, texts[i]));
    }
}
