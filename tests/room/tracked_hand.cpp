// The orientation of a tracked hand: what the palm commands, and where the hand is drawn.
#include <doctest/doctest.h>

#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "tests/room/immersive_driver.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/need.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

AppOptions first_nut(const test::Folder& folder, xr::Side side) {
    AppOptions options = test::options("first-nut", false);
    options.choice.equipment.hand = HandMode::tracked;
    options.settings_file = folder.path() / "settings.json";
    content::TraineeSettings settings;
    settings.language = "en";
    settings.trainee = "Ada";
    settings.left_handed = side == xr::Side::left;
    test::need(write_file(options.settings_file, content::settings_text(settings)));
    return options;
}

double degrees_between(const Quat& a, const Quat& b) { return to_degrees(glm::length(turn_between(a, b))); }

// The frame of the drawn hand, in the assembly's.
struct DrawnHand {
    Pose frame, palm;
};
DrawnHand drawn_hand(const HeadlessTrainer& trainer) {
    DrawnHand drawn;
    scene::SceneWorld& world = const_cast<scene::SceneWorld&>(trainer.app().lesson()->workplace.world);
    world.view<const scene::SkinnedHand, const scene::Transform>().each(
        [&](ecs::Entity entity, const scene::SkinnedHand& fingers, const scene::Transform& transform) {
            if (world.find<scene::GhostPart>(entity) != nullptr) return;
            const glm::dmat4 at(transform.world);
            drawn.frame = {Vec3(at[3]), glm::quat_cast(glm::dmat3(at))};
            drawn.palm =
                drawn.frame * Pose{fingers.shown.position[hand::palm], fingers.shown.rotation[hand::palm]};
        });
    return drawn;
}

// The pose of the joint XR_HAND_JOINT_PALM_EXT (−Z along the fingers, Y out of the back of the hand) at this
// grip pose, from the text of OpenXR's specification: the grip's Y points from the fingertips to the wrist,
// its −Z to the thumb, and its X out of a left palm and into a right one.
Pose palm_joint(const Pose& grip, xr::Side side) {
    const double back = side == xr::Side::right ? 1.0 : -1.0;
    const Vec3 x = grip.orientation * Vec3(1.0, 0.0, 0.0), y = grip.orientation * Vec3(0.0, 1.0, 0.0);
    const glm::dmat3 axes(glm::cross(back * x, y), back * x, y);
    return {grip.position, glm::normalize(glm::quat_cast(axes))};
}

// Draws a frame in which hands and head stay, and saves it.
void save(HeadlessTrainer& trainer, const std::string& name) {
    trainer.draws = true;
    trainer.draw_interval = 1;
    trainer.frame();
    test::save_eyes(trainer, name);
    trainer.draws = false;
}

const Quat any_palm[] = {Quat(1.0, 0.0, 0.0, 0.0), rotation({0.0, to_radians(45.0), 0.0}),
                         rotation({0.0, to_radians(150.0), 0.0}), rotation({0.9, -0.4, 0.3}),
                         rotation({-1.2, 0.8, 1.5})};

}  // namespace

TEST_CASE("Tracked hand: an empty hand commands the palm's orientation, and is drawn where the palm is") {
    for (const xr::Side side : {xr::Side::right, xr::Side::left}) {
        CAPTURE(side == xr::Side::right);
        const test::Folder folder;
        HeadlessTrainer driver(first_nut(folder, side), {test::eye_size(), 0.3F, 0.02});
        driver.draws = false;
        driver.immersive = test::standing_user(test::eye_size());
        driver.frame();
        test::ImmersiveDriver hands(driver);
        test::TraineeInRoom trainee(hands, side);
        const double x = side == xr::Side::right ? 0.3 : -0.3;
        for (const Quat& turn : any_palm) {
            CAPTURE(to_degrees(glm::length(rotation_vector(turn))));
            const Pose palm{{x, 0.45, 0.35}, turn};
            for (double t = 0.0; t < 1.5; t += driver.step()) trainee.frame(palm, 0.0);
            // The tool's z axis points back along the fingers, as the palm's Y; its x is the palm's X.
            const Pose tool = driver.lesson().station->latest.commanded_tool;
            const Quat expected = turn * glm::angleAxis(-0.5 * pi, Vec3(1.0, 0.0, 0.0));
            CHECK(degrees_between(tool.orientation, expected) < 2.0);
            const DrawnHand drawn = drawn_hand(driver);
            const Pose real = palm_joint(palm, side);
            CHECK(degrees_between(drawn.palm.orientation, real.orientation) < 3.0);
            CHECK(glm::distance(drawn.palm.position, real.position) < 0.015);
        }
        save(driver, side == xr::Side::right ? "rolled-right" : "rolled-left");
    }
}

TEST_CASE("Tracked hand: at its first frame the tool goes to the hand without turning past it") {
    const test::Folder folder;
    HeadlessTrainer driver(first_nut(folder, xr::Side::right), {test::eye_size(), 0.3F, 0.02});
    driver.draws = false;
    driver.immersive = test::standing_user(test::eye_size());
    driver.frame();
    test::ImmersiveDriver hands(driver);
    test::TraineeInRoom trainee(hands);
    const Pose palm{{0.3, 0.45, 0.35}, rotation({0.0, to_radians(45.0), 0.0})};
    const Quat expected = palm.orientation * glm::angleAxis(-0.5 * pi, Vec3(1.0, 0.0, 0.0));
    for (int i = 0; i < 25; ++i) {
        trainee.frame(palm, 0.0);
        const Pose tool = driver.lesson().station->latest.commanded_tool;
        if (i >= 3) CHECK(degrees_between(tool.orientation, expected) < 5.0);
    }
}

TEST_CASE("Tracked hand: at a nut the drawn hand rolls with the wrist") {
    const test::Folder folder;
    HeadlessTrainer driver(first_nut(folder, xr::Side::right), {test::eye_size(), 0.3F, 0.02});
    driver.draws = false;
    driver.immersive = test::standing_user(test::eye_size());
    driver.frame();
    test::ImmersiveDriver hands(driver);
    test::TraineeInRoom trainee(hands);
    const session::LessonSession& session = *driver.lesson().session;
    const Vec3 axis = session.setup().nuts.front().axis;
    const Vec3 above = servo::nut_centre(session.setup().nuts.front(), 0.0) + 0.03 * axis;
    // The fingers point down to the nut.
    const Vec3 y(0.0, 1.0, 0.0);
    const Quat down = glm::normalize(Quat(1.0 + glm::dot(y, axis), glm::cross(y, axis)));
    Pose before;
    for (const double roll : {0.0, 60.0, 120.0}) {
        CAPTURE(roll);
        const Quat turned = glm::angleAxis(to_radians(roll), axis) * down;
        const Vec3 tips = turned * fingertips_at_palm(xr::Side::right).position;
        for (double t = 0.0; t < 2.0; t += driver.step()) trainee.frame({above - tips, turned}, 0.0);
        REQUIRE(hand_of(driver.lesson()).nut);
        const Pose frame = drawn_hand(driver).frame;
        // The fingers stay around the nut.
        CHECK(glm::dot(frame.orientation * Vec3(0.0, 0.0, 1.0), axis) > 0.99);
        if (roll > 0.0) {
            const Vec3 turn = turn_between(before.orientation, frame.orientation);
            CHECK(to_degrees(glm::dot(turn, axis)) == doctest::Approx(60.0).epsilon(0.05));
        }
        before = frame;
        save(driver, "roll-" + std::to_string(static_cast<int>(roll)));
    }
}

TEST_CASE("Tracked hand: the palm of a hand of joints is that of a controller at the same place") {
    for (const xr::Side side : {xr::Side::right, xr::Side::left})
        for (const Quat& turn : any_palm) {
            const Pose grip{{0.1, 1.2, -0.3}, turn};
            xr::HandInput hand;
            hand.active = true;
            CHECK_FALSE(palm_of(hand, side));
            hand.joints.emplace();
            CHECK_FALSE(palm_of(hand, side));  // no joint is valid
            hand.joints->front() = {palm_joint(grip, side), 0.03, true};
            const std::optional<Pose> palm = palm_of(hand, side);
            REQUIRE(palm);
            CHECK(degrees_between(palm->orientation, grip.orientation) < 1e-6);
            CHECK(glm::distance(palm->position, grip.position) < 1e-12);
            hand.active = false;
            CHECK_FALSE(palm_of(hand, side));
        }
}

TEST_CASE("Tracked hand: the hand at work does not press the buttons of the panel behind it") {
    RoomState room;
    room.panel = Pose{{0.0, 1.5, -0.75}, {1.0, 0.0, 0.0, 0.0}};
    xr::Hands hands;
    for (xr::HandInput& hand : hands.sides) {
        hand.active = true;
        hand.aim = xr::ReportedPose{{{0.1, 1.5, 0.0}, {1.0, 0.0, 0.0, 0.0}}, true};
    }
    hands[xr::Side::right].select = 1.0F;
    (void)hand_events(room, hands, {}, 0.01, xr::Side::right);
    CHECK(room.pointer.on_panel);  // by the left hand
    CHECK_FALSE(room.pointer.pressed);
    (void)hand_events(room, hands, {}, 0.01);
    CHECK(room.pointer.pressed);
}

TEST_CASE("Tracked hand: a glove gives the fingers, and controller or cameras the wrist") {
    for (const xr::Side side : {xr::Side::right, xr::Side::left}) {
        const hand::Hand model = hand::make_hand(side);
        const hand::Angles bent = hand::closed_hand_angles(0.4);
        station_setup::WornFingers fingers;
        fingers.joints = hand::joints(model, bent, {});
        fingers.side = side;
        fingers.closed_share = station_setup::closed_share(bent);
        CHECK(fingers.closed_share == doctest::Approx(0.4));
        const Pose wrist{{0.2, 1.1, -0.4}, glm::normalize(Quat(0.7, 0.1, -0.6, 0.3))};
        const Pose palm_joint{wrist * fingers.joints.position[hand::palm],
                              wrist.orientation * fingers.joints.rotation[hand::palm]};
        const auto is_at_wrist = [&](const xr::HandInput& gloved, double degrees) {
            REQUIRE(gloved.active);
            REQUIRE(gloved.joints);
            CHECK_FALSE(gloved.grip);
            for (std::size_t i = 0; i < hand::joint_count; ++i) {
                const xr::HandJoint& joint = (*gloved.joints)[i];
                CHECK(joint.valid);
                CHECK(glm::distance(joint.pose.position, wrist * fingers.joints.position[i]) < 1e-9);
                CHECK(degrees_between(joint.pose.orientation,
                                      wrist.orientation * fingers.joints.rotation[i]) < degrees);
            }
            CHECK(closed_share(gloved) == doctest::Approx(0.4).epsilon(1e-6));
        };
        // A controller whose place on the hand is registered. Its buttons do not close the hand.
        const Pose mount{{0.02, -0.06, 0.05}, glm::normalize(Quat(0.5, -0.4, 0.3, 0.7))};
        xr::HandInput worn;
        worn.active = true;
        worn.select = worn.grasp = 1.0F;
        worn.menu = worn.secondary = true;
        worn.grip = xr::ReportedPose{wrist * inverse(mount), true};
        worn.aim = worn.grip;
        const auto gloved = [&](const xr::HandInput& hand, const WristMount& at) {
            xr::Hands hands;
            hands[side] = hand;
            return with_glove(hands, fingers, at);
        };
        const WristMount on_controller{{}, {}, mount};
        const xr::HandInput without_buttons = gloved(worn, on_controller);
        is_at_wrist(without_buttons, 1e-6);
        CHECK_FALSE((without_buttons.menu || without_buttons.secondary || without_buttons.aim));
        CHECK(without_buttons.select == 0.0F);
        // Cameras that see the wrist, and other fingers than the glove measures.
        xr::HandInput seen;
        seen.active = true;
        seen.joints.emplace();
        (*seen.joints)[hand::wrist] = {wrist, 0.02, true};
        is_at_wrist(gloved(seen, on_controller), 1e-6);
        is_at_wrist(gloved(seen, {}), 1e-6);
        // A controller in the hand: the palm of the glove's hand is at its grip pose.
        xr::HandInput held;
        held.active = true;
        const double out = side == xr::Side::right ? 1.0 : -1.0;
        const glm::dmat3 grip_at_palm(Vec3(0.0, out, 0.0), Vec3(0.0, 0.0, 1.0), Vec3(out, 0.0, 0.0));
        held.grip = xr::ReportedPose{
            {palm_joint.position, glm::normalize(palm_joint.orientation * glm::quat_cast(grip_at_palm))},
            true};
        is_at_wrist(gloved(held, {}), 1e-6);
        // A hand that is not tracked is not drawn, whatever the glove measures.
        CHECK_FALSE(gloved({}, on_controller).active);
        // A Vive tracker whose place on the hand is registered. While it is lost, no other device replaces
        // it: a controller on the table may be active.
        const WristMount on_tracker{TrackerRole::left_elbow, mount, {}};
        xr::Hands hands;
        hands[side] = held;
        hands[side].joints = seen.joints;
        hands.trackers.has_data = hands.trackers.available = true;
        CHECK_FALSE(with_glove(hands, fingers, on_tracker).active);
        std::optional<xr::ReportedPose>& tracker =
            hands.trackers.poses[static_cast<std::size_t>(TrackerRole::left_elbow)];
        tracker = xr::ReportedPose{wrist * inverse(mount), true};
        is_at_wrist(with_glove(hands, fingers, on_tracker), 1e-6);
        CHECK(wrist_fault(hands.trackers, on_tracker).empty());
        CHECK(wrist_fault(hands.trackers, {}).empty());
        CHECK(wrist_fault(hands.trackers, {TrackerRole::waist, mount}).find("has the role waist") !=
              std::string::npos);
        // A tracker that is not registered moves nothing, and the user reads why.
        hands[side] = held;
        is_at_wrist(with_glove(hands, fingers, {TrackerRole::left_elbow, {}}), 1e-6);
        CHECK(wrist_fault(hands.trackers, {TrackerRole::left_elbow, {}})
                  .find("not registered with the Vive tracker left_elbow; expected") != std::string::npos);
    }
}
