// The touch of a marker in the room that checks, before a lesson begins, whether the arm is where its
// registration says.
#include "game/trainer/touch_check.hpp"

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/room/immersive_driver.hpp"
#include "tests/station/virtual_time_station.hpp"

namespace touch_check_test {

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

constexpr std::uint32_t button = 4;
const Pose arm_in_room{{0.3, 0.9, -0.2}, rotation({0.0, 0.4, 0.0})};
const Vec3 tip{0.0, -0.02, 0.1};
const Quat handle = rotation({0.3, -0.5, 0.1});
const Vec3 marker{0.1, 1.2, -0.6};  // in the room

content::Registration registration() {
    content::Registration one;
    one.pose = arm_in_room;
    one.date = "2026-11-20T10:00:00Z";
    one.rms = 1.2e-3;
    one.tip = tip;
    one.check_point = PointPair{inverse(arm_in_room) * marker, marker};
    return one;
}

// The pose of the handle, in the frame of the arm, whose tip is at a point of the room.
Pose handle_at(const Vec3& point) { return {inverse(arm_in_room) * point - handle * tip, handle}; }

// A lesson with a registered arm that a test holds.
struct TouchedLesson {
    test::VirtualTimeStation* bench = nullptr;
    std::optional<HeadlessTrainer> driver;

    explicit TouchedLesson(const content::Registration& registered,
                           const std::optional<Pose>& workpiece_in_room = {}) {
        AppOptions options = test::options("cover-m8", false);
        options.choice.equipment.hand = HandMode::keyboard;
        content::StationFile& station = options.choice.equipment.station;
        station.arm.emplace().device = "force-dimension:0";
        station.registrations.push_back(registered);
        if (workpiece_in_room) {
            content::Registration& workpiece = station.registrations.emplace_back(registered);
            workpiece.from = content::CoordinateFrame::workpiece;
            workpiece.pose = *workpiece_in_room;
            workpiece.check_point.reset();
        }
        options.start_station =
            [this](const content::Assembly& assembly, const session::LessonOptions& lesson, const Equipment&,
                   const std::string&,
                   const device::ArmDialog&) -> Result<std::unique_ptr<station_setup::LessonStation>> {
            BOLT_TRY_ASSIGN(auto prepared, session::prepare_session(assembly, lesson));
            auto made = std::make_unique<test::VirtualTimeStation>(std::move(prepared), lesson, 1.0);
            bench = made.get();
            bench->hold({});
            return made;
        };
        driver.emplace(std::move(options), test::Display{test::eye_size(), 0.3F, 0.02});
        driver->immersive = test::standing_user(test::eye_size());
        play(1.0);
    }
    void play(double seconds) {
        const int frames = static_cast<int>(std::lround(seconds / 0.02));
        for (int i = 0; i < frames; ++i) {
            if (bench != nullptr) bench->advance(0.02);
            driver->draws = i + 3 > frames;  // drawing takes most of the time
            driver->frame();
        }
        driver->draws = true;
    }
    void press(platform::Key key) {
        driver->frame({platform::KeyEvent{key, true, false, {}}});
        driver->frame({platform::KeyEvent{key, false, false, {}}});
    }
    // The picture while the tip is held at a point of the room.
    std::vector<std::uint8_t> picture_at(const Vec3& point) {
        bench->hold({handle_at(point), 0});
        play(0.1);
        return driver->room_picture(0).rgba;
    }
    [[nodiscard]] bool shows(const char* label) const {
        const std::vector<render::Label>& labels = lesson().scene.labels;
        return std::any_of(labels.begin(), labels.end(),
                           [&](const render::Label& one) { return one.text == label; });
    }
    // Holds the tip at a point of the room and presses a button.
    void touch(const Vec3& point) {
        bench->hold({handle_at(point), 0});
        play(0.2);
        bench->hold({handle_at(point), button});
        play(0.6);
        bench->hold({handle_at(point), 0});
        play(0.1);
    }
    [[nodiscard]] const std::optional<TouchCheck>& check() const { return driver->app().room()->touch; }
    [[nodiscard]] const ActiveLesson& lesson() const { return *driver->app().lesson(); }
    [[nodiscard]] bool offers(words::TextKey label) const {
        const auto widgets = driver->app().drawn_widgets();
        return std::any_of(widgets.begin(), widgets.end(),
                           [&](const DrawnWidget& widget) { return widget.label == label; });
    }
    [[nodiscard]] bool logged(const char* words) const {
        const std::vector<std::string>& lines = driver->log();
        return std::any_of(lines.begin(), lines.end(),
                           [&](const std::string& line) { return line.find(words) != std::string::npos; });
    }
};

}  // namespace

TEST_CASE("Touch check: it is read from either direction of a registration that has a check point") {
    content::Registration one = registration();
    const auto forth = touch_check_of(one);
    std::swap(one.from, one.to);
    std::swap(one.check_point->from, one.check_point->to);
    one.pose = inverse(one.pose);
    const auto back = touch_check_of(one);
    REQUIRE((forth && back));
    for (const auto& check : {*forth, *back}) {
        CHECK(glm::length(check.marker - marker) < 1e-12);
        CHECK(glm::length(check.arm_in_room * (handle_at(marker) * check.tip) - marker) < 1e-12);
    }
    one.check_point.reset();
    CHECK(!touch_check_of(one));
}

TEST_CASE("Touch check: a lesson waits for a touch of the marker, states the error and begins") {
    TouchedLesson at(registration());
    REQUIRE(at.check());
    CHECK(at.lesson().session->time() == 0.0);
    CHECK(at.offers("touch.skip"));
    CHECK(!at.offers("menu.go_on"));
    test::save_eyes(*at.driver, "touch-asks");

    at.touch(marker + Vec3(0.0, 0.003, 0.0));
    REQUIRE(at.check());
    CHECK(at.check()->phase == TouchPhase::passed);
    CHECK(at.check()->error == doctest::Approx(0.003).epsilon(1e-3));
    CHECK(at.offers("touch.start"));
    CHECK(at.lesson().scene.objects.size() > 4);
    CHECK(at.logged("a touch of the registration's check point is off by 3.0 mm"));
    CHECK(!at.logged("register the arm again"));
    CHECK(at.lesson().session->time() == 0.0);

    at.touch(marker);
    CHECK(!at.check());
    CHECK(at.lesson().session->time() > 0.2);
}

TEST_CASE(
    "Touch check: the picture has marker, tip and workshop, and near the marker nothing that follows the "
    "arm") {
    TouchedLesson at(registration());
    const std::vector<std::uint8_t> far = at.picture_at(marker + Vec3(0.16, 0.1, 0.05));
    CHECK(at.shows("Check point"));
    CHECK(at.shows("Tip of the arm"));
    CHECK(at.lesson().scene.labels.size() == 2);
    test::save_eyes(*at.driver, "touch-far");
    const std::size_t objects = at.lesson().scene.objects.size();
    CHECK(objects > 5);  // the workshop too
    const std::vector<std::uint8_t> near = at.picture_at(marker + Vec3(0.02, -0.01, 0.0));
    CHECK(at.shows("Check point"));
    CHECK(!at.shows("Tip of the arm"));
    test::save_eyes(*at.driver, "touch-near");
    CHECK(near != far);
    CHECK(near == at.picture_at(marker + Vec3(-0.01, 0.02, 0.03)));
    // Without samples of the arm there is no tip.
    (void)at.picture_at(marker + Vec3(0.16, 0.1, 0.05));
    CHECK(at.shows("Tip of the arm"));
    at.bench->unplugged_ = true;
    at.play(0.1);
    CHECK(!at.shows("Tip of the arm"));
    CHECK(at.lesson().scene.objects.size() == objects - 1);
}

TEST_CASE("Touch check: a registered workpiece stands in its place, and does not follow the arm") {
    std::size_t objects = 0;
    {
        TouchedLesson without(registration());
        (void)without.picture_at(marker);
        objects = without.lesson().scene.objects.size();
    }
    TouchedLesson at(registration(), Pose{{-0.05, 1.15, -0.55}, rotation({0.0, 0.3, 0.0})});
    const std::vector<std::uint8_t> shown = at.picture_at(marker);
    test::save_eyes(*at.driver, "touch-workpiece");
    CHECK(at.lesson().scene.objects.size() > objects);
    CHECK(shown == at.picture_at(marker + Vec3(0.0, 0.03, 0.0)));
}

TEST_CASE("Touch check: a headset that can shows the real room until the touch, whatever the setting") {
    TouchedLesson at(registration());
    at.driver->immersive->has_passthrough = true;
    const auto clear = [&] {
        const std::vector<std::uint8_t> picture = at.picture_at(marker);
        std::size_t count = 0;
        for (std::size_t alpha = 3; alpha < picture.size(); alpha += 4)
            count += picture[alpha] == 0 ? 1U : 0U;
        return static_cast<double>(count) / (0.25 * static_cast<double>(picture.size()));
    };
    CHECK(at.driver->app().wants_passthrough());
    CHECK(clear() > 0.5);
    test::save_eyes(*at.driver, "touch-passthrough");
    at.touch(marker);
    CHECK(at.check()->phase == TouchPhase::passed);
    CHECK(!at.driver->app().wants_passthrough());
    CHECK(clear() == 0.0);
}

TEST_CASE("Touch check: an arm that was moved gives a warning, and the lesson can be played") {
    TouchedLesson at(registration());
    at.touch(marker + Vec3(0.006, 0.0, 0.0));
    REQUIRE(at.check());
    CHECK(at.check()->phase == TouchPhase::failed);
    CHECK(at.logged("is off by 6.0 mm; register the arm again"));
    test::save_eyes(*at.driver, "touch-wrong");
    test::press_on_panel(*at.driver, "touch.start");
    at.play(0.2);
    CHECK(!at.check());
    CHECK(at.lesson().session->time() > 0.0);
}

TEST_CASE(
    "Touch check: Escape and the button skip it, Enter measures, and a hand that moves is asked to repeat") {
    {
        TouchedLesson skipped(registration());
        skipped.press(platform::Key::escape);
        skipped.play(0.2);
        CHECK(!skipped.check());
        CHECK(skipped.lesson().session->time() > 0.0);
        CHECK(skipped.logged("the check of the arm's registration was skipped"));
        CHECK(skipped.driver->app().room()->touch_done);
    }
    {
        TouchedLesson skipped(registration());
        test::press_on_panel(*skipped.driver, "touch.skip");
        skipped.play(0.2);
        CHECK(!skipped.check());
        CHECK(skipped.lesson().session->time() > 0.0);
    }
    TouchedLesson at(registration());
    at.bench->hold({handle_at(marker), 0});
    at.play(0.1);
    at.press(platform::Key::enter);
    at.play(0.1);
    at.bench->hold({handle_at(marker + Vec3(0.0, 0.0, 0.01)), 0});
    at.play(0.5);
    REQUIRE(at.check());
    CHECK(at.check()->phase == TouchPhase::waiting);
    CHECK(at.check()->failed_touch);
    at.bench->unplugged_ = true;  // nothing is measured without samples
    at.play(0.1);
    at.press(platform::Key::enter);
    at.play(0.5);
    CHECK(at.check()->phase == TouchPhase::waiting);
    at.bench->unplugged_ = false;
    at.bench->hold({handle_at(marker), 0});
    at.play(0.6);
    at.press(platform::Key::enter);
    at.play(0.5);
    CHECK(at.check()->phase == TouchPhase::passed);
    CHECK(at.check()->error < 1e-9);
}

TEST_CASE("Touch check: slow pictures measure for longer, and a held button is no press") {
    TouchCheck check = *touch_check_of(registration());
    const std::optional<station::MoverSample> held{station::MoverSample{handle_at(marker), button}};
    const std::optional<station::MoverSample> open{station::MoverSample{handle_at(marker), 0}};
    CHECK(!update(check, held, false, 0.2));
    CHECK(check.phase == TouchPhase::waiting);
    CHECK(!update(check, open, false, 0.2));
    CHECK(!update(check, held, false, 0.2));
    CHECK(check.phase == TouchPhase::measuring);
    for (int i = 0; i < 4; ++i) CHECK(!update(check, held, false, 0.2));
    CHECK(check.phase == TouchPhase::measuring);
    CHECK(!update(check, held, false, 0.2));
    CHECK(check.phase == TouchPhase::passed);
    CHECK(!update(check, held, false, 0.2));
    CHECK(!update(check, open, false, 0.2));
    CHECK(update(check, held, false, 0.2));
}

}  // namespace touch_check_test
