// A whole lesson in the mock headset with a CyberGlove: an emulated glove on a serial port measures the
// fingers, and a controller or a Vive tracker that is fixed to the back of the hand measures the wrist. The
// buttons of the controller are never pressed.
//
// BOLT_HEADSET_PICTURES: a folder for pictures of both eyes, 0.2 s of the lesson apart.
#include <cstdlib>

#include "content/trainee/glove_calibration.hpp"
#include "game/station/frame_registration.hpp"
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

trainer::AppOptions options(const std::filesystem::path& port, const std::optional<TrackerRole>& tracker) {
    trainer::AppOptions options = test::headset_lesson_options("first-nut", BOLT_TRAINER_OUT);
    options.out = std::filesystem::path(BOLT_TRAINER_OUT) / (tracker ? "gloved_tracker" : "gloved");
    options.choice.equipment.station.wrist_tracker = tracker;
    options.choice.trainee = wearer;
    options.choice.equipment.glove = port;
    content::Registration registered;
    registered.from = content::CoordinateFrame::hand;
    registered.to = station_setup::wrist_frame(tracker);
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

bool has_fault(const trainer::App& app, const char* part) {
    const std::vector<std::string>& faults = app.lesson()->station->fault_messages;
    return std::any_of(faults.begin(), faults.end(),
                       [&](const std::string& fault) { return fault.find(part) != std::string::npos; });
}

// At the beginning of the lesson the tracker is switched off, then it has another role. Each time the user
// reads why the hand stays where it is.
void lose_tracker(test::HeadsetDriver& driver, const test::MockRuntime& mock, const Pose& head) {
    const Pose at{{0.2, 1.2, -0.3}};
    const trainer::App& app = driver.app();
    const auto show = [&](bool connected, const char* role) {
        mock->set_vive_tracker({"LHR-1", role, connected, {at}});
        for (int i = 0; i < 3; ++i) driver.frame(head, {});
        return app.lesson()->station->tracked->present;
    };
    CHECK(show(true, "right_wrist"));
    CHECK_FALSE(has_fault(app, "Vive tracker"));
    const Pose fingertips = app.lesson()->station->tracked->fingertips;
    CHECK_FALSE(show(false, "right_wrist"));
    CHECK(has_fault(app,
                    "glove: the Vive tracker right_wrist is not tracked; expected one that is switched on"));
    CHECK(glm::distance(app.lesson()->station->tracked->fingertips.position, fingertips.position) < 1e-9);
    CHECK_FALSE(show(true, "waist"));
    CHECK(has_fault(app, "has the role right_wrist; there are waist; expected"));
    CHECK(show(true, "right_wrist"));
    CHECK_FALSE(has_fault(app, "Vive tracker"));
}

// `tracker`: measures the wrist instead of a controller, which lies on the table meanwhile.
void play_gloved_lesson(const std::optional<TrackerRole>& tracker) {
    mock::Config config;
    if (tracker) config.extensions.emplace_back(mock::vive_tracker_extension);
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
    test::Program program(options(glove.port(), tracker), platform::Size{160, 120});
    double wanted = 0.0;  // share by which the hand is to be closed
    test::HeadsetDriverOptions how;
    how.draw_interval = pictures != nullptr ? 0.2 : 2.0;
    if (pictures != nullptr)
        how.pictures = std::filesystem::path(pictures) / (tracker ? "gloved_tracker" : "gloved");
    how.settled = [&] {
        const trainer::ActiveLesson* lesson = program.app->lesson();
        if (lesson == nullptr || !lesson->station) return true;
        const station_setup::WornFingers* fingers = lesson->station->link->worn_fingers();
        return fingers != nullptr && fingers->measured && std::abs(fingers->closed_share - wanted) < 0.03;
    };
    const auto send = [&](const Pose& head, const xr::Hands& hands) {
        mock->set_head({head});
        mock::Hand none;
        none.active = false;
        mock->set_hand(mock::Side::left, none);
        const xr::HandInput& right = hands[Side::right];
        wanted = static_cast<double>(std::max(right.grasp, right.select));
        glove.set_raw(emulate::raw_values(hand::closed_hand_angles(wanted)));
        mock::Hand shown;
        if (tracker) {
            shown.grip.pose = shown.aim.pose = {{0.6, 0.8, 0.1}, rotation({0.5, 1.0, 0.0})};
            mock->set_hand(mock::Side::right, shown);
            if (right.grip)
                mock->set_vive_tracker(
                    {"LHR-1", std::string(name(*tracker)), true, {controller_of(right.grip->pose, worn)}});
            return Status();
        }
        shown.active = right.active;
        shown.grip.valid = shown.grip.tracked = right.grip.has_value();
        if (right.grip) shown.grip.pose = controller_of(right.grip->pose, worn);
        shown.aim = shown.grip;
        mock->set_hand(mock::Side::right, shown);
        return Status();
    };
    test::HeadsetDriver driver(*program.app, send, how);
    test::play_lesson_in_headset(program, driver, [&](const Pose& head) {
        if (tracker) lose_tracker(driver, mock, head);
    });
}

}  // namespace

TEST_CASE("Headset lesson: a gloved hand with a controller on its back plays first-nut") {
    play_gloved_lesson({});
}

TEST_CASE("Headset lesson: a gloved hand with a Vive tracker plays first-nut, and reads when it is lost") {
    play_gloved_lesson(TrackerRole::right_wrist);
}
