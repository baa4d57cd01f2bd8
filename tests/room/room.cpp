// Lessons in a room: head and hands of a headset, without the headset.
#include <doctest/doctest.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"
#include "game/scene/workplace.hpp"
#include "game/view/pictures.hpp"
#include "tests/room/immersive_driver.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/need.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/free_hand_user.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

const VkExtent2D eye_size = test::eye_size();

AppOptions tracked_hand(const char* assembly) {
    AppOptions o = test::options(assembly, false);
    o.choice.equipment.hand = HandMode::tracked;
    return o;
}

// The options with a settings file in `folder` for a trainee, changed by `change`.
template <class Change>
AppOptions with_settings(AppOptions options, const test::Folder& folder, const Change& change) {
    options.settings_file = folder.path() / "settings.json";
    content::TraineeSettings settings;
    settings.language = "en";
    settings.trainee = "Ada";
    change(settings);
    test::need(write_file(options.settings_file, content::settings_text(settings)));
    return options;
}

}  // namespace

TEST_CASE("Room: workpiece and panel stand in front of the user, and stay when the head moves") {
    HeadlessTrainer driver(tracked_hand("cover-m8"), {eye_size, 0.3F, 0.02});
    driver.immersive = test::standing_user(eye_size);
    driver.frame();
    driver.frame();
    REQUIRE(driver.app().room());
    const RoomState room = *driver.app().room();
    REQUIRE(room.workpiece);
    REQUIRE(room.panel);
    driver.immersive->head.position += Vec3(0.2, -0.1, 0.1);
    driver.immersive->groups = {test::two_eyes(driver.immersive->head, eye_size)};
    driver.frame();
    CHECK(driver.app().room()->workpiece->position == room.workpiece->position);
    CHECK(driver.app().room()->panel->position == room.panel->position);
    test::save_eyes(driver, "lesson");
}

TEST_CASE("Room: the workpiece is within reach of the user's arm, and at the height for seated eyes") {
    for (const auto& user : {std::pair{0.46, std::optional<double>()},
                             {0.69, std::optional<double>()},
                             {0.69, std::optional(1.0)}}) {
        const auto& reach = user.first;
        const auto& seat = user.second;
        CAPTURE(reach);
        const test::Folder folder;
        HeadlessTrainer driver(with_settings(tracked_hand("first-nut"), folder,
                                             [&](content::TraineeSettings& s) {
                                                 s.arm_reach = reach;
                                                 s.seated_eye_height = seat;
                                             }),
                               {eye_size, 0.3F, 0.02});
        driver.draws = false;
        driver.immersive = test::standing_user(eye_size);
        driver.frame();
        REQUIRE(driver.app().room()->workpiece);
        const Pose place = *driver.app().room()->workpiece;
        const render::BoundingBox& box = driver.lesson().workplace.workpiece;
        const Vec3 front = place * Vec3(0.5F * (box.low.x + box.high.x), box.low.y, box.high.z);
        CHECK(-front.z == doctest::Approx(0.40 * reach / 0.69).epsilon(1e-3));
        const double floor = front.y - scene::floor_below_plate;
        CHECK(floor == doctest::Approx(seat ? 1.65 - *seat : 0.0));
    }
}

TEST_CASE("Room: the trainee's setting shows the real room in place of the workshop, if the headset can") {
    const test::Folder folder;
    HeadlessTrainer driver(with_settings(tracked_hand("cover-m8"), folder,
                                         [](content::TraineeSettings& s) { s.passthrough = true; }),
                           {eye_size, 0.3F, 0.02});
    REQUIRE_MESSAGE(driver.app().preferences().settings.passthrough,
                    driver.app().preferences().file_error_message);
    driver.immersive = test::standing_user(eye_size);
    driver.draw_interval = 1;
    for (const bool possible : {false, true}) {
        CAPTURE(possible);
        driver.immersive->has_passthrough = possible;
        driver.frame();
        driver.frame();
        const render::Picture picture = driver.room_picture(0);
        std::size_t clear = 0, covered = 0;
        for (std::size_t alpha = 3; alpha < picture.rgba.size(); alpha += 4) {
            clear += picture.rgba[alpha] == 0 ? 1U : 0U;
            covered += picture.rgba[alpha] == 255 ? 1U : 0U;
        }
        const std::size_t pixels = picture.rgba.size() / 4;
        if (!possible) CHECK(covered == pixels);
        if (possible) CHECK(clear > pixels / 3);
        if (possible) CHECK(covered > pixels / 100);  // workpiece and hand
        test::save_eyes(driver, possible ? "passthrough" : "workshop");
    }
}

TEST_CASE("Room: the menu is a panel that the hand points at, and its buttons are pressed by the trigger") {
    AppOptions menu = tracked_hand("cover-m8");
    menu.menu = true;
    HeadlessTrainer driver(std::move(menu), {eye_size, 0.3F, 0.02});
    driver.immersive = test::standing_user(eye_size);
    for (int i = 0; i < 40; ++i) driver.frame();
    test::save_eyes(driver, "menu");
    REQUIRE(driver.app().room()->panel);
    test::press_on_panel(driver, "menu.start");
    CHECK(driver.app().screen() == ShownScreen::lesson);
    CHECK(driver.app().room()->pointer.on_panel);
    test::save_eyes(driver, "started");
}

TEST_CASE("Room: a tracked hand runs a nut down with its fingers, takes the wrench, aligns it and tightens") {
    HeadlessTrainer driver(tracked_hand("first-nut"), {eye_size, 0.3F, 0.02});
    driver.immersive = test::standing_user(eye_size);
    driver.frame();
    driver.draws = false;
    REQUIRE(driver.lesson().station);
    std::vector<std::pair<double, xr::Vibration>> felt;  // time of the lesson, s
    driver.immersive->vibrate = [&](xr::Side side, const xr::Vibration& vibration) {
        CHECK(side == xr::Side::right);
        felt.emplace_back(driver.lesson().session->time(), vibration);
    };
    double tightening = 0.0;  // s, when the jaw first holds the nut
    test::ImmersiveDriver hands(driver);
    test::TraineeInRoom trainee(hands);
    int pulls = 0;  // frames with the force at the wrist
    trainee.on_frame = [&] {
        const ActiveLesson& lesson = driver.lesson();
        for (const render::Label& label : lesson.scene.labels) {
            // No label covers another one at the nut.
            for (const render::Label& other : lesson.scene.labels)
                CHECK((&label == &other || glm::distance(label.position, other.position) > 1e-3F));
            if (!label.text.ends_with(" N")) continue;
            ++pulls;
            const servo::Setup& setup = lesson.session->setup();
            const double torque = world::joint_at(lesson.workplace.world, 0).torque;
            CHECK(std::abs(std::stod(label.text.substr(label.text.find(' '))) -
                           std::abs(torque) / setup.wrench.handle_length) <= 0.5);
            const Vec3 end = lesson.workplace.world.only<world::ConstrainedTool>().pose *
                             Vec3(setup.wrench.handle_length, 0.0, 0.0);
            CHECK(glm::distance(Vec3(label.position), end) < 0.1);
        }
        if (tightening == 0.0 && hand_of(driver.lesson()).wrench &&
            driver.lesson().session->state().engagement.joint >= 0)
            tightening = driver.lesson().session->time();
    };
    trainee.play(120.0);
    CHECK(driver.app().screen() == ShownScreen::result);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
    // The nut clicks by under the fingers, and the load grows under the wrench.
    const auto strongest = [&](double from, double to) {
        float most = 0.0F;
        for (const auto& [time, vibration] : felt)
            if (time >= from && time < to) most = std::max(most, vibration.amplitude);
        return most;
    };
    REQUIRE(tightening > 5.0);
    CHECK(pulls > 20);
    CHECK(std::count_if(felt.begin(), felt.end(), [&](const auto& one) { return one.first < tightening; }) >
          20);
    CHECK(strongest(0.0, 5.0) > 0.0F);
    CHECK(strongest(tightening, 1e9) > strongest(0.0, 5.0));
    for (const auto& [time, vibration] : felt)
        CHECK((vibration.amplitude > 0.0F && vibration.amplitude <= 1.0F));
    MESSAGE("score " << driver.outcome()->result.score << ", approaches " << trainee.approaches);
}

TEST_CASE("Room: a seated trainee finishes the first nut with the left hand") {
    const test::Folder folder;
    HeadlessTrainer driver(with_settings(tracked_hand("first-nut"), folder,
                                         [](content::TraineeSettings& s) {
                                             s.left_handed = true;
                                             s.seated_eye_height = 1.15;
                                         }),
                           {eye_size, 0.3F, 0.02});
    REQUIRE_MESSAGE(driver.app().preferences().settings.left_handed,
                    driver.app().preferences().file_error_message);
    // A headset without a floor: its origin is where the head was.
    Pose head = test::standing_head();
    head.position = Vec3(0.0);
    driver.immersive = test::standing_user(eye_size);
    driver.immersive->head = head;
    driver.immersive->floor_known = false;
    driver.immersive->groups = {test::two_eyes(head, eye_size)};
    bool left_vibrates = false;
    driver.immersive->vibrate = [&](xr::Side side, const xr::Vibration&) {
        CHECK(side == xr::Side::left);
        left_vibrates = true;
    };
    driver.frame();
    const Pose workpiece = driver.app().room()->workpiece.value_or(Pose{});
    const double plate = workpiece.position.y + double{driver.lesson().workplace.workpiece.low.y};
    CHECK(plate - scene::floor_below_plate == doctest::Approx(-1.15));
    driver.draw_interval = 1;
    driver.frame();
    test::save_eyes(driver, "seated-left");
    driver.draws = false;
    test::ImmersiveDriver hands(driver);
    test::TraineeInRoom trainee(hands, xr::Side::left);
    trainee.head = head;
    trainee.play(120.0);
    CHECK(driver.app().screen() == ShownScreen::result);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
    CHECK(left_vibrates);
}

TEST_CASE("Room: a lesson pauses while its user does not see it, and when the headset is lost") {
    HeadlessTrainer driver(tracked_hand("first-nut"), {eye_size, 0.3F, 0.02});
    driver.draws = false;
    driver.immersive = test::standing_user(eye_size);
    test::ImmersiveDriver hands(driver);
    test::TraineeInRoom trainee(hands);
    driver.frame();
    trainee.hold_still(0.2, 0.0);
    REQUIRE_FALSE(driver.lesson().clock.paused);
    driver.immersive->attentive = false;
    trainee.hold_still(0.1, 0.0);
    CHECK(driver.lesson().clock.paused);
    const double then = driver.lesson().session->time();
    trainee.hold_still(0.3, 0.0);
    CHECK(driver.lesson().session->time() - then < 0.05);
    driver.immersive->attentive = true;
    trainee.hold_still(0.1, 0.0);
    CHECK_FALSE(driver.lesson().clock.paused);
    driver.immersive.reset();
    driver.frame();
    CHECK(driver.lesson().clock.paused);
    CHECK_FALSE(driver.app().room()->plays_in_room);
    driver.frame();
    CHECK(glm::length(driver.lesson().station->latest.output.force) == 0.0);
    // It returns where it was, and the lesson goes on.
    const Pose workpiece = driver.app().room()->workpiece.value();
    driver.immersive = test::standing_user(eye_size);
    driver.immersive->head.position += Vec3(0.3, 0.0, 0.2);
    driver.frame();
    CHECK_FALSE(driver.lesson().clock.paused);
    CHECK(driver.app().room()->workpiece->position == workpiece.position);
    // After the user has recentred, everything stands in front again.
    driver.immersive->recentred = true;
    driver.frame();
    CHECK(driver.app().room()->workpiece->position != workpiece.position);
    // At the window the user may go on without the headset.
    driver.immersive.reset();
    driver.frame();
    CHECK(driver.lesson().clock.paused);
    driver.key(platform::Key::escape);
    CHECK_FALSE(driver.lesson().clock.paused);
    driver.frame();
    CHECK_FALSE(driver.lesson().clock.paused);
}

TEST_CASE("Room: after its headset is lost, a lesson is finished with the mouse") {
    HeadlessTrainer driver(tracked_hand("first-nut"), {{320, 180}, 0.3F, 0.05});
    driver.immersive = test::standing_user(eye_size);
    driver.frame();
    test::ImmersiveDriver hands(driver);
    test::TraineeInRoom trainee(hands);
    trainee.hold_still(1.0, 0.0);
    REQUIRE(driver.lesson().station->tracked);
    driver.immersive.reset();
    driver.draw_interval = 1;
    driver.frame();
    driver.frame();
    REQUIRE(driver.lesson().clock.paused);
    const auto widgets = driver.app().drawn_widgets();
    const auto button = std::find_if(widgets.begin(), widgets.end(), [](const DrawnWidget& widget) {
        return widget.label == words::TextKey("room.use_mouse");
    });
    REQUIRE(button != widgets.end());
    const glm::dvec2 at(button->middle);
    driver.move(at);
    driver.press(at);
    driver.release(at);
    driver.frame();
    driver.frame();
    driver.draw_interval = 5;
    CHECK_FALSE(driver.lesson().clock.paused);
    REQUIRE(driver.lesson().station->dragged);
    CHECK_FALSE(driver.lesson().station->tracked);
    test::FreeHandUser user(driver);
    user.play(120.0);
    CHECK(driver.app().screen() == ShownScreen::result);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
}

TEST_CASE("Room: the stick turns the workpiece by a step, once, and raises it as fast in every frame rate") {
    RoomState room;
    xr::Hands hands;
    xr::HandInput& left = hands[xr::Side::left];
    left.active = true;
    left.stick = {0.9F, 0.0F};
    for (int i = 0; i < 5; ++i) (void)hand_events(room, hands, {}, 0.01);
    CHECK(room.turns == 1);
    left.stick = {0.0F, 0.0F};
    (void)hand_events(room, hands, {}, 0.01);
    left.stick = {-0.9F, 0.0F};
    (void)hand_events(room, hands, {}, 0.01);
    CHECK(room.turns == 0);
    for (const int frames : {20, 90}) {
        room.height = 0.0;
        left.stick = {0.0F, 1.0F};
        for (int i = 0; i < frames; ++i) (void)hand_events(room, hands, {}, 1.0 / frames);
        CHECK(room.height == doctest::Approx(0.2));
    }
    // About the vertical through the middle of the workpiece.
    render::BoundingBox box;
    box.low = {-0.1F, 0.0F, -0.2F};
    box.high = {0.3F, 0.4F, 0.2F};
    const Vec3 middle(0.1, 0.2, 0.0);
    const Pose turned = adjusted({}, box, 3, 0.05);
    CHECK(glm::distance(turned * middle, middle + Vec3(0.0, 0.05, 0.0)) < 1e-6);
    CHECK(glm::distance(turned * (middle + Vec3(1.0, 0.0, 0.0)), middle + Vec3(0.0, 0.05, -1.0)) < 1e-6);
}

TEST_CASE("Room: the vignette closes while the scene moves, and opens when it stands") {
    Vignette vignette;
    Pose scene;
    const auto frames = [&](int count, double seconds, double speed) {
        for (int i = 0; i < count; ++i) {
            scene.position.y += speed * seconds;
            update(vignette, scene, seconds);
        }
        return vignette.strength;
    };
    CHECK(frames(20, 0.01, 0.0) == 0.0);
    CHECK(frames(5, 0.01, 0.2) == doctest::Approx(0.5));
    CHECK(frames(10, 0.01, 0.2) == 1.0);
    CHECK(frames(20, 0.01, 0.001) == doctest::Approx(0.5));  // slower than anyone sees
    CHECK(frames(25, 0.01, 0.0) == 0.0);
    CHECK(frames(1, 0.01, 20.0) == 0.0);  // a jump
    scene.orientation = rotation({0.0, turn_step, 0.0});
    CHECK(frames(1, 0.01, 0.0) == 0.0);
}

TEST_CASE("Room: raising the workpiece darkens the edge of the view, unless the setting is off") {
    for (const bool darkens : {true, false}) {
        CAPTURE(darkens);
        const test::Folder folder;
        HeadlessTrainer driver(with_settings(tracked_hand("first-nut"), folder,
                                             [&](content::TraineeSettings& s) { s.vignette = darkens; }),
                               {eye_size, 0.3F, 0.02});
        driver.immersive = test::standing_user(eye_size);
        driver.draw_interval = 1;
        const auto brightness = [&](double x, double y) {  // 0 … 1 of width and height
            const render::Picture picture = driver.room_picture(0);
            double sum = 0.0;
            const auto left = static_cast<std::uint32_t>(x * (picture.width - 8)),
                       top = static_cast<std::uint32_t>(y * (picture.height - 8));
            for (std::uint32_t row = top; row < top + 8; ++row)
                for (std::uint32_t column = left; column < left + 8; ++column)
                    sum += picture.rgba[4 * (std::size_t{row} * picture.width + column)];
            return sum / 64.0;
        };
        driver.frame();
        driver.frame();
        const double edge = brightness(0.0, 0.9), middle = brightness(0.5, 0.5);
        REQUIRE(edge > 10.0);
        xr::HandInput& left = driver.immersive->hands[xr::Side::left];
        left.active = true;
        left.stick = {0.0F, 1.0F};
        for (int i = 0; i < 8; ++i) driver.frame();
        test::save_eyes(driver, darkens ? "vignette" : "no-vignette");
        CHECK((brightness(0.0, 0.9) < 0.1 * edge) == darkens);
        CHECK(brightness(0.5, 0.5) > 0.3 * middle);
        left.stick = {0.0F, 0.0F};
        for (int i = 0; i < 30; ++i) driver.frame();
        CHECK(brightness(0.0, 0.9) > 0.5 * edge);
    }
}

TEST_CASE("Room: the hints name the hands, and the menu offers them") {
    HeadlessTrainer driver(tracked_hand("first-nut"), {eye_size, 0.3F, 0.02});
    driver.draws = false;
    driver.frame();
    const words::LoadedWords words = words::load_words(words::words_folder(), "en");
    REQUIRE(words.ok());
    const lesson::ControlNames names =
        control_names(words.words, KeyMap{}, Equipment{}, &*driver.lesson().station);
    for (std::size_t i = 1; i < names.size(); ++i) {
        CAPTURE(names[i]);
        CHECK_FALSE(names[i].empty());
        CHECK(names[i].find("key") == std::string::npos);
        CHECK(names[i].find("press") == std::string::npos);
    }
    std::vector<DeviceOption> options = device_options({});
    const std::size_t before = options.size();
    offer_tracked_hand(options);
    offer_tracked_hand(options);
    CHECK(options.size() == before + 1);
    CHECK(options.back().equipment.hand == HandMode::tracked);
}
