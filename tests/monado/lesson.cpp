// Whole lessons in a headset of Monado, whose remote driver gets the trainee's poses. tests/monado.sh runs
// them.
//
// BOLT_MONADO_PICTURES: a folder for pictures of both eyes.
#include <cstdlib>

#include "tests/headset_lesson/headset_driver.hpp"
#include "tests/monado/remote_headset.hpp"
#include "tests/support/skip.hpp"

using namespace bolt;

namespace {

constexpr platform::Size window_size{320, 240};

// Fingers that the runtime simulates around a controller: how far the program finds them closed.
double closing_by_fingers(test::HeadsetDriver& driver, const Pose& head, float bent) {
    xr::Hands hands;
    xr::HandInput& hand = hands[xr::Side::left];
    hand.active = true;
    hand.grip = xr::ReportedPose{{{-0.4, 1.3, -0.2}, {1.0, 0.0, 0.0, 0.0}}, true};
    hand.joints.emplace();
    hand.grasp = bent;
    for (int i = 0; i < 3; ++i) driver.frame(head, hands);
    xr::HandInput received = driver.received()[xr::Side::left];
    REQUIRE(received.joints);
    received.grasp = 0.0F;
    return trainer::closed_share(received);
}

void play_lesson(const std::string& assembly) {
    auto remote = test::RemoteHeadset::connect();
    if (!remote) return test::skip_rest(remote.error().message());
    test::Program program(test::headset_lesson_options(assembly, BOLT_TRAINER_OUT), window_size);
    test::HeadsetDriverOptions how;
    how.draw_interval = 0.2;
    if (const char* pictures = std::getenv("BOLT_MONADO_PICTURES"))
        how.pictures = std::filesystem::path(pictures) / assembly;
    test::HeadsetDriver driver(
        *program.app,
        [&remote](const Pose& head, const xr::Hands& hands) { return remote->send(head, hands); }, how);
    test::play_lesson_in_headset(program, driver, [&driver](const Pose& head) {
        CHECK(closing_by_fingers(driver, head, 0.0F) < 0.1);
        CHECK(closing_by_fingers(driver, head, 1.0F) > 0.9);
    });
}

}  // namespace

TEST_CASE("Monado: first-nut is played by a driven hand") { play_lesson("first-nut"); }
TEST_CASE("Monado: cover-m8 is played by a driven hand") { play_lesson("cover-m8"); }
