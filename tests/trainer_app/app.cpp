// The trainer without a window: events go in, pictures come out, and somebody plays a whole lesson by
// pointing, pressing and dragging alone.
#include <doctest/doctest.h>

#include <algorithm>

#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/view/labels.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"
#include "tests/trainer_app/desk.hpp"
#include "tests/trainer_app/person.hpp"

using namespace bolt;
using namespace bolt::trainer;

namespace {

using test::Desk;
using test::options;
using test::Person;

}  // namespace

TEST_CASE("from the menu to the result: a lesson played by pointing, pressing and dragging") {
    Desk desk(options("cover-m8", true));
    desk.frame();
    CHECK(desk.app().shows() == Shows::menu);
    desk.push("menu.start");
    desk.frame();
    REQUIRE(desk.app().shows() == Shows::lesson);
    desk.key(platform::Key::i);  // the close-up has tests of its own, and costs as much as the picture
    Person person(desk);
    if (test::sanitized) {
        person.play(400.0, 1);
        CHECK(desk.playing().course->lesson().current == 1);
        return test::skip_rest("the lesson after its first step takes minutes under a sanitizer");
    }
    person.play(400.0);
    REQUIRE(desk.played());
    CHECK(desk.app().shows() == Shows::result);
    const lesson::LessonResult& result = desk.played()->result;
    CHECK(result.finished);
    CHECK(result.score > 85.0);
    MESSAGE("score " << result.score << " in " << result.duration << " s, " << person.presses
                     << " presses, looked " << person.looks << " times for a nut");
    for (const lesson::JointResult& joint : result.joints) CHECK(joint.order_errors == 0);
    MESSAGE(desk.told().back());
    desk.frame();
    const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->header().operator_name == "person");
    // And again, or back to the menu.
    desk.push("menu.again");
    CHECK(desk.app().shows() == Shows::lesson);
    CHECK(desk.playing().course->time() < 1.0);
    desk.frame();
    desk.key(platform::Key::escape);
    desk.push("menu.end");
    desk.frame();
    desk.push("menu.menu");
    CHECK(desk.app().shows() == Shows::menu);
    desk.frame();
    desk.push("menu.quit");
    CHECK(desk.app().closed());
}

TEST_CASE("what is pressed in a frame is done in that frame's ticks, and its picture shows it") {
    Desk desk(options("cover-m8", false));
    desk.frame();
    desk.frame();
    const Vec3 before = hand_of(desk.playing()).pose.position;
    const auto shown = [&] {
        glm::vec3 all(0.0F);
        for (const render::Object& object : desk.playing().scene.objects)
            if (object.deformation) all += glm::vec3(object.world[3]);
        return all;
    };
    const glm::vec3 picture = shown();
    desk.frame({platform::KeyEvent{platform::Key::t, true, false, {}}});
    CHECK(hand_of(desk.playing()).doing == Doing::reaching);
    CHECK(glm::distance(hand_of(desk.playing()).pose.position, before) > 1e-4);
    CHECK(shown() != picture);
}

TEST_CASE("a mistake in a guided lesson begins its step again and says why; in practice it asks") {
    for (const lesson::Mode mode : {lesson::Mode::guided, lesson::Mode::practice}) {
        AppOptions o = options("cover-m8", false);
        o.choice.mode = mode;
        Desk desk(o);
        desk.frame();
        const ActiveLesson& p = desk.playing();
        const std::size_t other = (p.course->lesson().due()->joint + 1) % 4;
        const glm::dvec2 at = desk.hold(other);
        desk.move(at + glm::dvec2(100.0, 0.0));
        for (int i = 0; i < 30 && !p.coaching.mistakes.shown; ++i) desk.frame();
        REQUIRE(p.coaching.mistakes.shown);
        CHECK(p.coaching.mistakes.shown->cause == lesson::Cause::out_of_turn);
        REQUIRE(p.course->state().joints[other].nut.angle > 0.0);
        for (int i = 0; i < 10; ++i)
            desk.frame();  // a hand that goes on grips anew, and makes no other mistake
        desk.release(at);
        for (int i = 0; i < 40 && p.course->state().joints[other].nut.angle > 0.0; ++i) desk.frame();

        const bool guided = mode == lesson::Mode::guided;
        CHECK((p.course->state().joints[other].nut.angle == 0.0) == guided);
        CHECK(hand_of(p).nut.has_value() != guided);
        CHECK(p.course->lesson().joints[other].result.order_errors == 1);
        if (guided) CHECK(p.coaching.mistakes.shown);
    }
}

TEST_CASE("a mistake in the last step of a guided lesson begins that again, too; only then it is over") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const test::OneJoint one("cover-m8");
    AppOptions o = options(one.name().c_str(), false);
    o.out = one.folder() / "out";
    Desk desk(o);
    desk.frame();
    desk.key(platform::Key::i);  // as above
    const ActiveLesson& p = desk.playing();
    REQUIRE(p.course->lesson().steps.size() == 2);
    Person person(desk);
    person.play(200.0, 1);
    REQUIRE(p.course->lesson().current == 1);
    const double seated = p.course->state().joints[0].nut.angle;
    person.sought = 1.3;
    for (int i = 0; i < 20 && !p.coaching.mistakes.shown; ++i) person.play(p.course->time() + 1.0, 2);
    REQUIRE(p.coaching.mistakes.shown);
    CHECK(p.coaching.mistakes.shown->cause == lesson::Cause::over_torque);
    CHECK(p.course->state().joints[0].nut.angle > seated);
    const auto marked = [&] {
        return std::any_of(p.scene.labels.begin(), p.scene.labels.end(), [](const render::Label& label) {
            return label.text.rfind(view::due_sign, 0) == 0;
        });
    };
    int left = 0;  // frames between the end of the step and its return
    for (int i = 0; i < 60 && p.course->state().joints[0].nut.angle > seated; ++i) {
        desk.frame();
        CHECK(marked());  // nothing else seems due meanwhile
        left += p.course->lesson().current == 2 ? 1 : 0;
    }
    CHECK(left > 0);
    CHECK(p.course->state().joints[0].nut.angle == seated);
    CHECK(p.course->lesson().current == 1);
    CHECK(p.coaching.mistakes.shown);
    REQUIRE(desk.app().shows() == Shows::lesson);

    person.sought = 1.0;
    person.play(200.0, 2);
    desk.frame();
    REQUIRE(desk.app().shows() == Shows::result);
    CHECK(desk.played()->result.finished);
    CHECK(desk.played()->result.joints[0].torque < 22.0);
    CHECK(desk.played()->result.score == 98.0);
    const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
    REQUIRE(reader);
    auto at = session::prepare_again(*reader);
    REQUIRE(at);
    const auto replayed =
        session::replay(*reader, std::move(*at), [](const session::Moment&) { return true; });
    REQUIRE(replayed);
    CHECK(replayed->wrong == 0);
}

TEST_CASE("what a slow machine loses of the clock is known, and is not lost in a pause") {
    Desk desk(options("cover-m8", false));
    desk.frame();
    const double before = desk.playing().course->time();
    for (int i = 0; i < 4; ++i) desk.frame({}, 1.25);
    CHECK(desk.playing().course->time() - before == doctest::Approx(1.0).epsilon(0.01));
    CHECK(desk.playing().pace.lagged == doctest::Approx(4.0).epsilon(0.01));
    desk.key(platform::Key::escape);
    desk.frame({}, 3600.0);
    CHECK(desk.playing().pace.lagged == doctest::Approx(4.0).epsilon(0.01));
}

TEST_CASE("paused, nothing goes on; ended, the session is kept as it stands") {
    Desk desk(options("cover-m8", false));
    desk.frame();
    REQUIRE(desk.app().shows() == Shows::lesson);
    desk.frame();
    const double before = desk.playing().course->time();
    CHECK(before > 0.0);
    desk.key(platform::Key::escape);
    const double paused = desk.playing().course->time();
    for (int i = 0; i < 5; ++i) desk.frame();
    CHECK(desk.playing().course->time() == paused);
    const Vec3 tool = tool_of(desk.playing()).pose.position, hand = hand_of(desk.playing()).pose.position;
    const std::size_t drawn = desk.playing().scene.objects.size();
    REQUIRE(glm::length(tool) > 0.0);
    desk.another_gpu();
    desk.frame();
    CHECK(desk.playing().course->time() == paused);
    // The world outlives its pictures.
    CHECK(tool_of(desk.playing()).pose.position == tool);
    CHECK(hand_of(desk.playing()).pose.position == hand);
    CHECK(desk.playing().scene.objects.size() == drawn);
    desk.push("menu.go_on");
    desk.frame();
    CHECK(desk.playing().course->time() > paused);
    desk.key(platform::Key::escape);
    desk.frame();
    desk.push("menu.end");
    desk.frame();
    REQUIRE(desk.played());
    CHECK_FALSE(desk.played()->result.finished);
    CHECK(desk.app().shows() == Shows::result);
    const std::string low(view::sign_of(lesson::Verdict::low));
    for (const render::Label& label : desk.playing().scene.labels)
        CHECK(label.text.substr(0, low.size()) == low);
    CHECK(desk.playing().scene.labels.size() == 4);
    const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
}

TEST_CASE("a step is taken back: the nut is where it was, the step due again, and the session replays so") {
    Desk desk(options("cover-m8", false));
    desk.frame();
    desk.key(platform::Key::i);  // as above
    Person person(desk);
    person.play(100.0, 1);
    const session::Course& course = *desk.playing().course;
    REQUIRE(course.lesson().current == 1);
    const std::size_t first = course.lesson().steps[0].joint;
    REQUIRE(course.state().joints[first].nut.angle > 6.0);
    desk.key(platform::Key::backspace);
    for (int i = 0; i < 100 && course.lesson().current == 1; ++i) desk.frame();
    CHECK(course.lesson().current == 0);
    CHECK(course.state().joints[first].nut.angle == 0.0);
    // And it is done once more.
    if (test::sanitized)
        test::skip_part("doing the step again takes minutes under a sanitizer");
    else
        person.play(200.0, 1);
    CHECK(course.lesson().current == (test::sanitized ? 0 : 1));
    // To where this one began, which is where it is.
    desk.key(platform::Key::r);
    for (int i = 0; i < 40; ++i) desk.frame();
    CHECK(course.lesson().current == (test::sanitized ? 0 : 1));
    desk.key(platform::Key::escape);
    desk.push("menu.end");
    const auto reader = session::Reader::open(desk.folder() / "session.boltwright");
    REQUIRE(reader);
    auto at = session::prepare_again(*reader);
    REQUIRE(at);
    std::size_t back = 0;
    const auto replayed = session::replay(*reader, std::move(*at), [&](const session::Moment& moment) {
        for (const lesson::Event& event : moment.lesson.events) back += event.kind == "back" ? 1U : 0U;
        return true;
    });
    REQUIRE(replayed);
    CHECK(replayed->wrong == 0);
    CHECK(back == 2);
}

TEST_CASE(
    "a press counts where it was, also in a frame so slow that the pointer came, pressed and went on in it") {
    Desk desk(options("cover-m8", false));
    desk.frame();
    const ActiveLesson& p = desk.playing();
    const std::size_t first = p.course->lesson().due()->joint, other = (first + 1) % 4;
    const glm::dvec2 away(5.0, 90.0);
    desk.release(desk.hold(first));
    desk.move(away);
    for (int i = 0; i < 40 && p.mouse.doing != Doing::resting; ++i) desk.frame();
    REQUIRE_FALSE(p.pointing.nut);
    const auto there = project(desk.screen(), servo::nut_centre(p.course->setup().nuts[other], 0.0));
    REQUIRE(there);
    desk.frame({platform::CursorEvent{*there}, platform::ButtonEvent{platform::Button::left, true, *there},
                platform::CursorEvent{away}});
    CHECK(p.mouse.nut == other);
}

TEST_CASE("something is said in every language, and nothing in an assessment") {
    for (const char* language : {"de", "zh", "en"}) {
        AppOptions o = options("cover-m8", false);
        o.choice.language = language;
        o.choice.mode = std::string(language) == "en" ? lesson::Mode::assessment : lesson::Mode::guided;
        Desk desk(std::move(o));
        for (int i = 0; i < 5; ++i) desk.frame();
        const bool helped = std::string(language) != "en";
        CHECK(desk.playing().coaching.hints.shown.has_value() == helped);
        const Vec3 before = desk.playing().view.camera.goal.target;
        desk.key(platform::Key::v);
        CHECK((desk.playing().view.camera.goal.target != before) == helped);
    }
}

TEST_CASE("an assembly that is not there: the menu says so and stays") {
    Desk desk(options("no-such-thing", true));
    desk.frame();
    desk.push("menu.start");
    desk.frame();
    CHECK(desk.app().shows() == Shows::menu);
    REQUIRE(desk.app().trouble());
    CHECK(desk.app().trouble()->message().find("no-such-thing") != std::string::npos);
}
