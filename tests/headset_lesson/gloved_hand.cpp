// A whole lesson in the mock headset with a CyberGlove: an emulated glove on a serial port measures the
// fingers, and a controller that is fixed to the back of the hand measures the wrist. Its buttons are never
// pressed.
//
// BOLT_HEADSET_PICTURES: a folder for pictures of both eyes, 0.2 s of the lesson apart.
#include <cstdlib>

#include "content/trainee/glove_calibration.hpp"
#include "game/trainer/tracked_hand.hpp"
#include "tests/headset_lesson/headset_driver.hpp"
#include "tests/mock_openxr/mock_runtime.hpp"
#include "tests/support/environment.hpp"
#include "tests/support/folder.hpp"
#include "tools/emulate/glove.hpp"

using namespace bolt;

namespace {

constexpr const char* wearer = "T-7K3M9Q";

// The wrist in the frame of the controller's grip pose: the controller is on the back of the hand, askew.
Pose wrist_at_controller() { return {{0.015, -0.04, 0.06}, glm::normalize(Quat(0.8, 0.2, -0.5, 0.1))}; }

content::GloveCalibration calibration() {
    content::GloveCalibration made;
    made.trainee = wearer;
    made.date = "2026-11-29";
    made.quality = 1.0;
    made.calibration.fits.fill(emulate::sensor_fit);
    return made;
}

trainer::AppOptions options(const std::filesystem::path& port) {
    trainer::AppOptions options = test::headset_lesson_options("first-nut", BOLT_TRAINER_OUT);
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / "gloved";
    options.choice.trainee = wearer;
    options.choice.equipment.glove = port;
    content::Registration registered;
    registered.from = content::CoordinateFrame::hand;
    registered.to = content::CoordinateFrame::controller;
    registered.pose = wrist_at_controller();
    options.choice.equipment.station.registrations.push_back(registered);
    return options;
}

// The grip pose of the controller on a hand whose palm has this grip pose.
Pose controller_of(const Pose& palm, const hand::Hand& hand) {
    const hand::Skeleton flat = hand::joints(hand, {}, {});
    const Pose palm_joint{flat.position[hand::palm], flat.rotation[hand::palm]};
    const Pose wrist = palm * trainer::fingertips_at_palm(hand.side) *
                       trainer::palm_joint_at_fingertips(hand.side) * inverse(palm_joint);
    return wrist * inverse(wrist_at_controller());
}

}  // namespace

TEST_CASE("Headset lesson: a gloved hand with a controller on its back plays first-nut") {
    mock::Config config;
    const char* pictures = std::getenv("BOLT_HEADSET_PICTURES");
    if (pictures != nullptr) {
        config.width = config.max_width = 480;
        config.height = config.max_height = 360;
    }
    const test::Folder folder;
    const test::EnvironmentVariable home("XDG_DATA_HOME", folder.path().c_str());
    const std::filesystem::path gloves = folder.path() / "boltwright" / "gloves";
    std::filesystem::create_directories(gloves);
    test::need(content::save_glove_calibration(content::glove_calibration_path(gloves, wearer, Side::right),
                                               calibration()));
    emulate::SerialGlove glove = test::need(emulate::SerialGlove::start({}));
    const hand::Hand worn = hand::make_hand(Side::right);

    const test::MockRuntime mock(config);
    test::Program program(options(glove.port()), platform::Size{160, 120});
    double wanted = 0.0;  // share by which the hand is to be closed
    test::HeadsetDriverOptions how;
    how.draw_interval = pictures != nullptr ? 0.2 : 2.0;
    if (pictures != nullptr) how.pictures = std::filesystem::path(pictures) / "gloved";
    how.settled = [&] {
        const trainer::ActiveLesson* lesson = program.app->lesson();
        if (lesson == nullptr || !lesson->station) return true;
        const station_setup::WornFingers* fingers = lesson->station->link->worn_fingers();
        return fingers != nullptr && fingers->measured && std::abs(fingers->closing - wanted) < 0.03;
    };
    const auto send = [&](const Pose& head, const xr::Hands& hands) {
        mock->set_head({head});
        mock::Hand none;
        none.active = false;
        mock->set_hand(mock::Side::left, none);
        const xr::HandInput& right = hands[Side::right];
        mock::Hand shown;
        shown.active = right.active;
        shown.grip.valid = shown.grip.tracked = right.grip.has_value();
        if (right.grip) shown.grip.pose = controller_of(right.grip->pose, worn);
        shown.aim = shown.grip;
        mock->set_hand(mock::Side::right, shown);
        wanted = static_cast<double>(std::max(right.grasp, right.select));
        glove.set_raw(emulate::raw_values(hand::closed_hand_angles(wanted)));
        return Status();
    };
    test::HeadsetDriver driver(*program.app, send, how);
    test::play_lesson_in_headset(program, driver);
}
