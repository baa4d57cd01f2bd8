// A whole lesson in the mock headset, through OpenXR's loader, the window and its frames.
//
// BOLT_HEADSET_PICTURES: a folder for pictures of both eyes, 0.2 s of the lesson apart.
#include <cstdlib>

#include "tests/headset_lesson/headset_driver.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"

using namespace bolt;

namespace {

mock::Hand controller(const xr::HandInput& hand) {
    mock::Hand shown;
    shown.active = hand.active;
    shown.trigger = hand.select;
    shown.squeeze = hand.grasp;
    shown.grip.valid = shown.grip.tracked = hand.grip.has_value();
    if (hand.grip) shown.grip.pose = hand.grip->pose;
    shown.aim = shown.grip;
    return shown;
}

void play_lesson(const std::string& assembly) {
    mock::Config config;
    const char* pictures = std::getenv("BOLT_HEADSET_PICTURES");
    if (pictures != nullptr) {
        config.width = config.max_width = 480;
        config.height = config.max_height = 360;
    }
    const test::MockRuntime mock(config);
    test::Program program(test::headset_lesson_options(assembly, BOLT_TRAINER_OUT), platform::Size{160, 120});
    test::HeadsetDriverOptions how;
    how.draw_interval = pictures != nullptr ? 0.2 : 2.0;
    if (pictures != nullptr) how.pictures = std::filesystem::path(pictures) / assembly;
    const auto send = [&mock](const Pose& head, const xr::Hands& hands) {
        mock->set_head({head});
        mock->set_hand(mock::Side::left, controller(hands[xr::Side::left]));
        mock->set_hand(mock::Side::right, controller(hands[xr::Side::right]));
        return Status();
    };
    test::HeadsetDriver driver(*program.app, send, how);
    test::play_lesson_in_headset(program, driver);
    CHECK_FALSE(driver.frames().unlike_trigger);
    const std::vector<mock::Vibration> felt = mock->take_vibrations();
    CHECK(std::count_if(felt.begin(), felt.end(),
                        [](const mock::Vibration& vibration) { return vibration.amplitude > 0.0F; }) > 50);
}

}  // namespace

TEST_CASE("Headset lesson: cover-m8 is played by a driven hand") { play_lesson("cover-m8"); }
