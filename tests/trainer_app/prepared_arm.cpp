// The trainer with an arm that must be prepared, before a lesson and in the middle of one.
#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "tests/station/virtual_time_station.hpp"
#include "tests/support/eventually.hpp"
#include "tests/trainer_app/headless_trainer.hpp"

using namespace bolt;
using namespace bolt::trainer;
using test::HeadlessTrainer;

namespace {

// Starts a station on the starter's thread whose arm first has the needs that the test gives it, as the
// station with a device does.
struct UnpreparedArm {
    std::atomic<test::VirtualTimeStation*> bench = nullptr;
    std::mutex mutex;
    device::Preparation needed{device::DeviceNeed::permission, {}};  // under the mutex
    std::atomic<int> moved = 0;
    std::atomic<bool> homing = false;  // until the test lets the arm arrive

    void need(const device::Preparation& preparation) {
        const std::lock_guard lock(mutex);
        needed = preparation;
    }
    device::Preparation now() {
        const std::lock_guard lock(mutex);
        return needed;
    }
    // False: the user has given up.
    bool prepare(const device::ArmDialog& dialog) {
        while (now().need != device::DeviceNeed::none) {
            if (!dialog.on_preparation(now())) return false;
            if (dialog.permission->acquire()) {
                ++moved;
                homing = true;
                while (homing) std::this_thread::sleep_for(std::chrono::milliseconds(1));
                dialog.permission->end();
                need({});
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return dialog.on_preparation({});
    }
    AppOptions options() {
        AppOptions o = test::options("cover-m8", true);
        o.choice.equipment.devices = {"an-arm"};
        o.start_station =
            [this](const content::Assembly& assembly, const session::LessonOptions& lesson_options,
                   const Equipment&, const std::string&,
                   const device::ArmDialog& dialog) -> Result<std::unique_ptr<station_setup::LessonStation>> {
            if (!prepare(dialog)) return fail(ErrorCode::no_device, "the arm is not prepared", "preparation");
            auto prepared = session::prepare_session(assembly, lesson_options);
            if (!prepared) return fail(prepared.error());
            auto made = std::make_unique<test::VirtualTimeStation>(std::move(*prepared), lesson_options);
            bench = made.get();
            return made;
        };
        return o;
    }
};

platform::InputEvent press_of(platform::Key key) { return platform::KeyEvent{key, true, false, {}}; }
platform::InputEvent press_of(platform::ControllerButton button) {
    return platform::ControllerEvent{button, true};
}

bool shows(const HeadlessTrainer& driver, words::TextKey label) {
    const auto buttons = driver.app().drawn_widgets();
    return std::any_of(buttons.begin(), buttons.end(),
                       [&](const DrawnWidget& button) { return button.label == label; });
}

// Records frames until the condition holds.
template <class Condition>
bool frames_until(HeadlessTrainer& driver, const Condition& condition) {
    return test::eventually([&] {
        driver.frame();
        return condition();
    });
}

void start(HeadlessTrainer& driver) {
    driver.frame();
    driver.press_button("menu.start");
    REQUIRE(frames_until(driver, [&] { return driver.app().arm_screen().needs.any(); }));
    CHECK(driver.app().screen() == ShownScreen::starting);
}

void wait_for_lesson(HeadlessTrainer& driver) {
    REQUIRE(frames_until(driver, [&] { return driver.app().screen() == ShownScreen::lesson; }));
}

}  // namespace

TEST_CASE(
    "Trainer with an unprepared arm: it moves after a key only, while pictures go on, and the lesson "
    "begins") {
    for (const auto& answer : {press_of(platform::Key::enter), press_of(platform::ControllerButton::start)}) {
        UnpreparedArm arm;
        HeadlessTrainer driver(arm.options());
        start(driver);
        driver.frame({answer}, 0.01);  // before the words can be read
        driver.wait(1.0);
        CHECK(arm.moved == 0);
        CHECK(shows(driver, "arm.move"));
        driver.frame({answer}, 0.1);
        REQUIRE(frames_until(driver, [&] { return arm.homing.load(); }));
        driver.wait(1.0);  // the arm is on its way
        CHECK(driver.app().screen() == ShownScreen::starting);
        CHECK(driver.app().arm_screen().needs.moves);
        CHECK_FALSE(shows(driver, "arm.move"));
        driver.frame({answer}, 0.1);
        arm.homing = false;
        wait_for_lesson(driver);
        CHECK(arm.moved == 1);
        driver.wait(1.0);
        CHECK_FALSE(shows(driver, "arm.move"));
        CHECK(driver.lesson().station.has_value());
    }
}

TEST_CASE("Trainer with an unprepared arm: Escape and the button lead back, and the arm does not move") {
    UnpreparedArm arm;
    HeadlessTrainer driver(arm.options());
    start(driver);
    driver.frame({press_of(platform::Key::escape)});
    CHECK(driver.app().screen() == ShownScreen::menu);
    CHECK_FALSE(driver.app().start_error());
    start(driver);
    driver.press_button("menu.back");
    CHECK(driver.app().screen() == ShownScreen::menu);
    start(driver);
    driver.frame({press_of(platform::ControllerButton::cancel)});
    CHECK(driver.app().screen() == ShownScreen::menu);
    CHECK(arm.moved == 0);
    CHECK(arm.bench == nullptr);
}

TEST_CASE(
    "Trainer with an unprepared arm: in its inkwell it goes on by itself, and its own words are shown") {
    UnpreparedArm arm;
    arm.need({device::DeviceNeed::inkwell, {}});
    HeadlessTrainer driver(arm.options());
    start(driver);
    driver.frame({press_of(platform::Key::enter)});
    driver.wait(1.0);
    CHECK(driver.app().screen() == ShownScreen::starting);
    CHECK_FALSE(shows(driver, "arm.move"));
    arm.need({device::DeviceNeed::user, "fold the elbow 折"});
    REQUIRE(frames_until(driver, [&] {
        return driver.app().arm_screen().needs.preparation.instruction == "fold the elbow 折";
    }));
    driver.wait(0.5);
    arm.need({});
    wait_for_lesson(driver);
    CHECK(arm.moved == 0);
}

TEST_CASE("Trainer with an unprepared arm: a failed start is reported in the menu") {
    UnpreparedArm arm;
    arm.need({});
    AppOptions options = arm.options();
    options.start_station = [](const auto&...) -> Result<std::unique_ptr<station_setup::LessonStation>> {
        return fail(ErrorCode::no_device, "the arm is not plugged in", "an arm");
    };
    HeadlessTrainer driver(std::move(options));
    driver.frame();
    driver.press_button("menu.start");
    REQUIRE(frames_until(driver, [&] { return driver.app().start_error().has_value(); }));
    CHECK(driver.app().screen() == ShownScreen::menu);
    CHECK(driver.app().start_error()->what == "the arm is not plugged in");
}

TEST_CASE(
    "Trainer with an unprepared arm: an arm that was switched off in a lesson asks again, and the lesson "
    "waits") {
    UnpreparedArm arm;
    arm.need({});
    HeadlessTrainer driver(arm.options());
    driver.frame();
    driver.press_button("menu.start");
    wait_for_lesson(driver);
    test::VirtualTimeStation& bench = *arm.bench;
    const auto pass = [&](double seconds, const std::vector<platform::InputEvent>& events = {}) {
        driver.frame(events, 0.1);
        for (double t = 0.0; t < seconds; t += 0.1) {
            bench.advance(0.1);
            driver.frame();
        }
    };
    pass(0.5);
    bench.needs_ = {{device::DeviceNeed::permission, {}}, false};
    pass(0.8);
    const double stopped = driver.lesson().session->time();
    CHECK(driver.lesson().clock.paused);
    CHECK(shows(driver, "arm.move"));
    CHECK_FALSE(shows(driver, "menu.go_on"));
    pass(0.5, {press_of(platform::Key::escape)});
    CHECK(driver.lesson().clock.paused);
    CHECK(bench.permissions_ == 0);
    pass(0.1, {press_of(platform::Key::enter)});
    CHECK(bench.permissions_ == 1);
    bench.needs_.moves = true;
    pass(0.8);
    CHECK_FALSE(shows(driver, "arm.move"));
    CHECK(driver.lesson().session->time() == stopped);
    bench.needs_ = {};
    pass(0.5);
    CHECK_FALSE(driver.lesson().clock.paused);
    CHECK(driver.lesson().session->time() > stopped);
    // Warm motors are a message, not a reason to stop.
    bench.health_.heat = 0.9;
    const double before = driver.lesson().session->time();
    pass(0.3);
    CHECK(arm_warning(driver.lesson().station->health) == words::TextKey("arm.warm"));
    CHECK(driver.lesson().session->time() > before);
    bench.health_.cooling = true;
    pass(0.3);
    CHECK(arm_warning(driver.lesson().station->health) == words::TextKey("arm.rests"));
    bench.health_ = {};
    pass(0.3);
    CHECK_FALSE(arm_warning(driver.lesson().station->health));
    // A pause of the user outlasts it.
    pass(0.2, {press_of(platform::Key::escape)});
    bench.needs_ = {{device::DeviceNeed::inkwell, {}}, false};
    pass(0.3);
    bench.needs_ = {};
    pass(0.3);
    CHECK(driver.lesson().clock.paused);
    CHECK(shows(driver, "menu.go_on"));
}
