// The trainer without a window. A simulated user plays lessons with input events only and sees the pictures.
#include <doctest/doctest.h>

#include <algorithm>

#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/view/labels.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/headless_trainer.hpp"
#include "tests/trainer_app/simulated_user.hpp"

using namespace bolt;
using namespace bolt::trainer;

namespace {

using test::HeadlessTrainer;
using test::options;
using test::SimulatedUser;

}  // namespace

TEST_CASE("Trainer: a lesson is played by mouse from the menu to the result") {
    HeadlessTrainer driver(options("cover-m8", true));
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::menu);
    driver.press_button("menu.start");
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    driver.key(platform::Key::i);  // hide the close-up: it has its own tests and doubles the rendering time
    SimulatedUser user(driver);
    if (test::sanitized) {
        user.play(400.0, 1);
        CHECK(driver.lesson().session->lesson().current == 1);
        return test::skip_rest("the lesson after its first step takes minutes under a sanitizer");
    }
    user.play(400.0);
    REQUIRE(driver.outcome());
    CHECK(driver.app().screen() == ShownScreen::result);
    const lesson::LessonResult& result = driver.outcome()->result;
    CHECK(result.finished);
    CHECK(result.score > 85.0);
    MESSAGE("score " << result.score << " in " << result.duration << " s, " << user.presses
                     << " presses, searched the view " << user.view_searches << " times");
    for (const lesson::JointResult& joint : result.joints) CHECK(joint.out_of_turn == 0);
    MESSAGE(driver.log().back());
    driver.frame();
    const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->header().trainee_profile == "person");
    // Once more, then back to the menu.
    driver.press_button("menu.again");
    CHECK(driver.app().screen() == ShownScreen::lesson);
    CHECK(driver.lesson().session->time() < 1.0);
    driver.frame();
    driver.key(platform::Key::escape);
    driver.press_button("menu.end");
    driver.frame();
    driver.press_button("menu.menu");
    CHECK(driver.app().screen() == ShownScreen::menu);
    driver.frame();
    driver.press_button("menu.quit");
    CHECK(driver.app().closed());
}

TEST_CASE("Trainer: a left-hand thread is run down and tightened by drags the other way") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const test::OneJoint one("cover-m8", "left");
    AppOptions o = options(one.name().c_str(), false);
    o.out = one.folder() / "out";
    HeadlessTrainer driver(o);
    driver.frame();
    driver.key(platform::Key::i);  // as above
    SimulatedUser user(driver);
    user.play(200.0, 1);
    CHECK(driver.lesson().session->lesson().current == 1);
    CHECK(driver.lesson().session->setup().nuts.front().sense == -1.0);
    user.play(200.0);
    REQUIRE(driver.outcome());
    CHECK(driver.outcome()->result.joints.front().overall == lesson::Verdict::ok);
}

TEST_CASE("Trainer: the ticks and the picture of a frame include the input of that frame") {
    HeadlessTrainer driver(options("cover-m8", false));
    driver.frame();
    driver.frame();
    const Vec3 before = hand_of(driver.lesson()).pose.position;
    const auto shown = [&] {
        glm::vec3 all(0.0F);
        for (const render::Object& object : driver.lesson().scene.objects)
            if (object.deformation) all += glm::vec3(object.world[3]);
        return all;
    };
    const glm::vec3 picture = shown();
    driver.frame({platform::KeyEvent{platform::Key::t, true, false, {}}});
    CHECK(hand_of(driver.lesson()).action == HandAction::reaching);
    CHECK(glm::distance(hand_of(driver.lesson()).pose.position, before) > 1e-4);
    CHECK(shown() != picture);
}

TEST_CASE(
    "Trainer: a mistake restarts its step and explains why in a guided lesson; in practice the trainee "
    "decides") {
    for (const lesson::Mode mode : {lesson::Mode::guided, lesson::Mode::practice}) {
        AppOptions o = options("cover-m8", false);
        o.choice.mode = mode;
        HeadlessTrainer driver(o);
        driver.frame();
        const ActiveLesson& p = driver.lesson();
        const std::size_t other = (p.session->lesson().due()->joint + 1) % 4;
        const glm::dvec2 at = driver.hold(other);
        driver.move(at + glm::dvec2(100.0, 0.0));
        for (int i = 0; i < 30 && !p.guidance.mistakes.shown; ++i) driver.frame();
        REQUIRE(p.guidance.mistakes.shown);
        CHECK(p.guidance.mistakes.shown->kind == lesson::MistakeKind::out_of_turn);
        REQUIRE(p.session->state().joints[other].nut.angle > 0.0);
        for (int i = 0; i < 10; ++i)
            driver.frame();  // a hand that continues grips again and makes no other mistake
        driver.release(at);
        for (int i = 0; i < 40 && p.session->state().joints[other].nut.angle > 0.0; ++i) driver.frame();

        const bool guided = mode == lesson::Mode::guided;
        CHECK((p.session->state().joints[other].nut.angle == 0.0) == guided);
        CHECK(hand_of(p).nut.has_value() != guided);
        CHECK(p.session->lesson().joints[other].result.out_of_turn == 1);
        if (guided) CHECK(p.guidance.mistakes.shown);
    }
}

TEST_CASE("Trainer: a mistake in the last step restarts that step before the lesson ends") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const test::OneJoint one("cover-m8");
    AppOptions o = options(one.name().c_str(), false);
    o.out = one.folder() / "out";
    HeadlessTrainer driver(o);
    driver.frame();
    driver.key(platform::Key::i);  // as above
    const ActiveLesson& p = driver.lesson();
    REQUIRE(p.session->lesson().steps.size() == 2);
    SimulatedUser user(driver);
    user.play(200.0, 1);
    REQUIRE(p.session->lesson().current == 1);
    const double seated = p.session->state().joints[0].nut.angle;
    user.torque_share = 1.3;
    for (int i = 0; i < 20 && !p.guidance.mistakes.shown; ++i) user.play(p.session->time() + 1.0, 2);
    REQUIRE(p.guidance.mistakes.shown);
    CHECK(p.guidance.mistakes.shown->kind == lesson::MistakeKind::over_torque);
    CHECK(p.session->state().joints[0].nut.angle > seated);
    const auto marked = [&] {
        return std::any_of(p.scene.labels.begin(), p.scene.labels.end(), [](const render::Label& label) {
            return label.text.rfind(view::due_symbol, 0) == 0;
        });
    };
    int left = 0;  // frames between the end of the step and the undo
    for (int i = 0; i < 60 && p.session->state().joints[0].nut.angle > seated; ++i) {
        driver.frame();
        CHECK(marked());  // no other joint is marked as due meanwhile
        left += p.session->lesson().current == 2 ? 1 : 0;
    }
    CHECK(left > 0);
    CHECK(p.session->state().joints[0].nut.angle == seated);
    CHECK(p.session->lesson().current == 1);
    CHECK(p.guidance.mistakes.shown);
    REQUIRE(driver.app().screen() == ShownScreen::lesson);

    user.torque_share = 1.0;
    user.play(200.0, 2);
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::result);
    CHECK(driver.outcome()->result.finished);
    CHECK(driver.outcome()->result.joints[0].torque < 22.0);
    CHECK(driver.outcome()->result.score == 98.0);
    const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
    REQUIRE(reader);
    auto at = session::restore_setup(*reader);
    REQUIRE(at);
    const auto replayed =
        session::replay(*reader, std::move(*at), [](const session::ReplayTick&) { return true; });
    REQUIRE(replayed);
    CHECK(replayed->mismatches == 0);
}

TEST_CASE("Trainer: the lag of a slow machine is counted, but not during a pause") {
    HeadlessTrainer driver(options("cover-m8", false));
    driver.frame();
    const double before = driver.lesson().session->time();
    for (int i = 0; i < 4; ++i) driver.frame({}, 1.25);
    CHECK(driver.lesson().session->time() - before == doctest::Approx(1.0).epsilon(0.01));
    CHECK(driver.lesson().clock.lag == doctest::Approx(4.0).epsilon(0.01));
    driver.key(platform::Key::escape);
    driver.frame({}, 3600.0);
    CHECK(driver.lesson().clock.lag == doctest::Approx(4.0).epsilon(0.01));
}

TEST_CASE("Trainer: a pause stops the lesson, and ending it keeps the session as it stands") {
    HeadlessTrainer driver(options("cover-m8", false));
    driver.frame();
    REQUIRE(driver.app().screen() == ShownScreen::lesson);
    driver.frame();
    const double before = driver.lesson().session->time();
    CHECK(before > 0.0);
    driver.key(platform::Key::escape);
    const double paused = driver.lesson().session->time();
    for (int i = 0; i < 5; ++i) driver.frame();
    CHECK(driver.lesson().session->time() == paused);
    const Vec3 tool = tool_of(driver.lesson()).pose.position, hand = hand_of(driver.lesson()).pose.position;
    const std::size_t drawn = driver.lesson().scene.objects.size();
    REQUIRE(glm::length(tool) > 0.0);
    driver.lose_gpu();
    driver.frame();
    CHECK(driver.lesson().session->time() == paused);
    // The world survives the loss of the GPU.
    CHECK(tool_of(driver.lesson()).pose.position == tool);
    CHECK(hand_of(driver.lesson()).pose.position == hand);
    CHECK(driver.lesson().scene.objects.size() == drawn);
    driver.press_button("menu.go_on");
    driver.frame();
    CHECK(driver.lesson().session->time() > paused);
    driver.key(platform::Key::escape);
    driver.frame();
    driver.press_button("menu.end");
    driver.frame();
    REQUIRE(driver.outcome());
    CHECK_FALSE(driver.outcome()->result.finished);
    CHECK(driver.app().screen() == ShownScreen::result);
    const std::string low(view::symbol_of(lesson::Verdict::low));
    for (const render::Label& label : driver.lesson().scene.labels)
        CHECK(label.text.substr(0, low.size()) == low);
    CHECK(driver.lesson().scene.labels.size() == 4);
    const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
}

TEST_CASE("Trainer: undo restores nut and step, and the session replays it") {
    HeadlessTrainer driver(options("cover-m8", false));
    driver.frame();
    driver.key(platform::Key::i);  // as above
    SimulatedUser user(driver);
    user.play(100.0, 1);
    const session::LessonSession& session = *driver.lesson().session;
    REQUIRE(session.lesson().current == 1);
    const std::size_t first = session.lesson().steps[0].joint;
    REQUIRE(session.state().joints[first].nut.angle > 6.0);
    driver.key(platform::Key::backspace);
    for (int i = 0; i < 100 && session.lesson().current == 1; ++i) driver.frame();
    CHECK(session.lesson().current == 0);
    CHECK(session.state().joints[first].nut.angle == 0.0);
    // The step can be done once more.
    if (test::sanitized)
        test::skip_part("doing the step again takes minutes under a sanitizer");
    else
        user.play(200.0, 1);
    CHECK(session.lesson().current == (test::sanitized ? 0 : 1));
    // A restart of the step returns to its beginning.
    driver.key(platform::Key::r);
    for (int i = 0; i < 40; ++i) driver.frame();
    CHECK(session.lesson().current == (test::sanitized ? 0 : 1));
    driver.key(platform::Key::escape);
    driver.press_button("menu.end");
    const auto reader = session::SessionReader::open(driver.folder() / "session.boltwright");
    REQUIRE(reader);
    auto at = session::restore_setup(*reader);
    REQUIRE(at);
    std::size_t back = 0;
    const auto replayed = session::replay(*reader, std::move(*at), [&](const session::ReplayTick& moment) {
        for (const lesson::LessonEvent& event : moment.lesson.events)
            back += event.kind == lesson::EventKind::undo ? 1U : 0U;
        return true;
    });
    REQUIRE(replayed);
    CHECK(replayed->mismatches == 0);
    CHECK(back == 2);
}

TEST_CASE("Trainer: a press counts at its position even if the pointer moves on in the same frame") {
    HeadlessTrainer driver(options("cover-m8", false));
    driver.frame();
    const ActiveLesson& p = driver.lesson();
    const std::size_t first = p.session->lesson().due()->joint, other = (first + 1) % 4;
    const glm::dvec2 away(5.0, 90.0);
    driver.release(driver.hold(first));
    driver.move(away);
    for (int i = 0; i < 40 && p.helped_hand.action != HandAction::resting; ++i) driver.frame();
    REQUIRE_FALSE(p.pointer.nut);
    const auto there = project(driver.projection(), servo::nut_centre(p.session->setup().nuts[other], 0.0));
    REQUIRE(there);
    driver.frame({platform::CursorEvent{*there}, platform::ButtonEvent{platform::Button::left, true, *there},
                  platform::CursorEvent{away}});
    CHECK(p.helped_hand.nut == other);
}

TEST_CASE("Trainer: hints are shown in every language, and none in an assessment") {
    for (const char* language : {"de", "zh", "en"}) {
        AppOptions o = options("cover-m8", false);
        o.choice.language = language;
        o.choice.mode = std::string(language) == "en" ? lesson::Mode::assessment : lesson::Mode::guided;
        HeadlessTrainer driver(std::move(o));
        for (int i = 0; i < 5; ++i) driver.frame();
        const bool helped = std::string(language) != "en";
        CHECK(driver.lesson().guidance.hints.shown.has_value() == helped);
        const Vec3 before = driver.lesson().view.camera.goal.target;
        driver.key(platform::Key::v);
        CHECK((driver.lesson().view.camera.goal.target != before) == helped);
    }
}

TEST_CASE("Trainer: a missing assembly is reported in the menu") {
    HeadlessTrainer driver(options("no-such-thing", true));
    driver.frame();
    driver.press_button("menu.start");
    driver.frame();
    CHECK(driver.app().screen() == ShownScreen::menu);
    REQUIRE(driver.app().start_error());
    CHECK(driver.app().start_error()->message().find("no-such-thing") != std::string::npos);
}
