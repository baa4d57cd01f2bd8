// The lesson's state machine, fed with ticks written by hand.

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::Script;

namespace {

// What is left of a long way's breakaway, relative.
constexpr double less_breakaway = 0.005;

// A tick of what turns with so much, and takes more as long as it has not broken away.
void break_away(Script& s, std::size_t joint, double running) {
    const double ratio = s.lesson.assembly->joints[joint].design.friction.static_ratio;
    s.tick(static_cast<int>(joint), servo::Grip::wrench,
           running * (1.0 + (ratio - 1.0) * s.state.joints[joint].breakaway), 1.0);
}

}  // namespace

TEST_CASE("Lesson: a nut that is not on its seat yet is not run down") {
    Script s;
    s.idle();
    s.tick(0, servo::Grip::fingers, 0.1, 1.0);
    s.idle();
    CHECK(s.lesson.current == 0);
    s.seat(0);
    CHECK(s.lesson.current == 1);
}

TEST_CASE(
    "Lesson: tightening below the window's low edge leaves the step due; reaching it ends the step at "
    "letting go") {
    Script s;
    s.seat_both();
    REQUIRE(s.lesson.current == 2);
    s.pull(0, 31.0);  // half of 63 is 31.5
    CHECK(s.lesson.current == 2);
    s.pull(0, 32.0);
    CHECK(s.lesson.current == 3);
}

TEST_CASE("Lesson: a step ends when the hand lets go, not before") {
    Script s;
    s.seat_both();
    for (int i = 0; i <= 100; ++i) s.tick(0, servo::Grip::wrench, 0.4 * i, 1.0);
    CHECK(s.lesson.current == 2);
    s.idle();
    CHECK(s.lesson.current == 3);
}

TEST_CASE("Lesson: by strategy yield a full step waits for yield, and gives up past the window") {
    Script s(Mode::guided, content::Strategy::yield);
    s.seat_both();
    s.pull(0, 35.0);
    s.pull(1, 35.0);
    REQUIRE(s.lesson.current == 4);
    s.pull(0, 70.0);
    CHECK(s.lesson.current == 4);
    s.state.joints[0].stage = joint::Stage::yield;
    s.tick(0, servo::Grip::wrench, 71.0, 1.0);
    s.idle();
    CHECK(s.lesson.current == 5);
    s.state.joints[1].stage = joint::Stage::linearity;
    s.pull(1, 78.0);
    CHECK(s.lesson.current == 6);
}

TEST_CASE(
    "Lesson: work out of turn is an order error once a visit, work on what is done a re-hit; a touch is "
    "neither") {
    Script s;
    s.seat_both();
    s.tick(1, servo::Grip::wrench, 0.2);
    s.idle();
    CHECK(s.lesson.joints[1].result.order_errors == 0);
    s.pull(1, 20.0);
    CHECK(s.lesson.joints[1].result.order_errors == 1);
    s.pull(0, 35.0);
    s.pull(0, 36.0);
    CHECK(s.lesson.joints[0].result.rehits == 1);
    CHECK(s.count("mistake") == 2);
}

TEST_CASE("Lesson: fingers that spin a nut out of turn grip it again and again, and are out of turn once") {
    Script s;
    s.idle();
    const auto grips = [&s](int times) {
        for (int i = 0; i < times; ++i) {
            for (int k = 0; k < 300; ++k) s.tick(1, servo::Grip::fingers, 0.1, 1.0);
            s.idle(150);
        }
    };
    grips(5);
    CHECK(s.lesson.joints[1].result.order_errors == 1);
    s.idle(1000);
    grips(2);
    CHECK(s.lesson.joints[1].result.order_errors == 2);
}

TEST_CASE("Lesson: fingers that feel once more whether a nut is down make no mistake, a wrench there does") {
    Script s;
    s.seat(0);
    REQUIRE(s.lesson.current == 1);
    s.tick(0, servo::Grip::fingers, 0.6);
    s.idle();
    CHECK(s.count("mistake") == 0);
    CHECK(s.lesson.joints[0].result.rehits == 0);
    s.pull(0, 5.0);
    CHECK(s.lesson.joints[0].result.rehits == 1);
    CHECK(s.lesson.current == 1);
}

TEST_CASE(
    "Lesson: nor do they at the last nut, whose step began the next pass, until a nut out of turn comes off "
    "its "
    "seat") {
    Script s;
    s.seat_both();
    REQUIRE(s.lesson.due()->joint == 0);
    s.tick(1, servo::Grip::fingers, 0.6);
    s.idle();
    CHECK(s.count("mistake") == 0);
    s.state.joints[1].stage = joint::Stage::navigation;
    s.idle(1000);
    s.tick(1, servo::Grip::fingers, 0.1, 1.0);
    s.idle();
    CHECK(s.lesson.joints[1].result.order_errors == 1);
}

TEST_CASE(
    "Lesson: a nut turned back from its seat was turned the wrong way: once a visit, and not by its play") {
    const auto told = [](const Script& s, Cause cause) {
        return std::count_if(s.lesson.events.begin(), s.lesson.events.end(),
                             [&](const Event& event) { return event.cause == cause; });
    };
    // A visit of so many degrees on, then back.
    const auto visit = [](Script& s, double on, double back, servo::Grip grip = servo::Grip::wrench) {
        for (int i = 0; i < 100; ++i) s.tick(0, grip, 5.0, to_radians(10.0 * on));
        for (int i = 0; i < 100; ++i) s.tick(0, grip, -5.0, to_radians(-10.0 * back));
        s.idle();
    };
    Script s;
    s.seat_both();
    visit(s, 20.0, 4.0);
    CHECK(told(s, Cause::loosened) == 0);
    visit(s, 0.0, 20.0);
    CHECK(told(s, Cause::loosened) == 1);
    visit(s, 20.0, 30.0);
    CHECK(told(s, Cause::loosened) == 2);
    s.state.joints[0].stage = joint::Stage::navigation;  // off its seat, and still turned
    visit(s, 0.0, 40.0);
    CHECK(told(s, Cause::loosened) == 2);
    CHECK(s.lesson.joints[0].wrong_ways == 2);

    SUBCASE("unless it had been pulled too far") {
        Script slackened;
        slackened.seat_both();
        slackened.pull(0, 90.0);
        visit(slackened, 0.0, 20.0);
        CHECK(told(slackened, Cause::over_torque) == 1);
        CHECK(told(slackened, Cause::loosened) == 0);
    }
    SUBCASE("in a lesson that loosens it is the other way") {
        Script off;
        off.state.joints[0].stage = joint::Stage::linearity;
        off.lesson = begin(off.assembly, Mode::guided, Task::loosen);
        visit(off, -30.0, 0.0);
        CHECK(told(off, Cause::tightened) == 0);
        visit(off, 20.0, 0.0);
        CHECK(told(off, Cause::tightened) == 1);
        CHECK(told(off, Cause::loosened) == 0);
    }
}

TEST_CASE("Lesson: pulled too far out of its step: the torque is not forgotten") {
    Script s;
    s.seat_both();
    s.pull(0, 95.0);
    s.pull(1, 35.0);
    s.pull(0, 70.0);
    s.pull(1, 70.0);
    REQUIRE(s.lesson.due() == nullptr);
    CHECK(judge_joint(s.lesson, 0, s.state).torque == doctest::Approx(95.0).epsilon(less_breakaway));
    CHECK(judge_joint(s.lesson, 0, s.state).overall == Verdict::high);
    CHECK(judge_joint(s.lesson, 1, s.state).overall == Verdict::ok);
}

TEST_CASE("Lesson: a nut that is taken off its seat begins anew: torque, snug and yield") {
    Script s;
    s.seat_both();
    s.pull(0, 95.0);
    s.state.joints[0].stage = joint::Stage::navigation;
    s.tick(0, servo::Grip::wrench, -0.1, -1.0);
    CHECK_FALSE(s.lesson.joints[0].snug);
    CHECK(s.lesson.joints[0].turned_torque == 0.0);
    s.idle();
    s.state.joints[0].stage = joint::Stage::transition;
    const double before = s.state.joints[0].nut.angle;
    s.pull(0, 70.0);
    CHECK(s.lesson.joints[0].snug_angle > before);
    CHECK(judge_joint(s.lesson, 0, s.state).torque == doctest::Approx(70.0).epsilon(less_breakaway));
}

TEST_CASE("Lesson: a nut that is turned by fits and starts is turned") {
    Script s;
    s.seat_both();
    for (int frame = 0; frame < 60; ++frame)  // as a mouse moves a hand: then and now, less than a degree
        for (int i = 0; i < 16; ++i) s.tick(0, servo::Grip::wrench, 95.0, i < 8 ? 0.8 : 0.0);
    s.tick(0, servo::Grip::wrench, 10.0);
    s.idle();
    CHECK(s.lesson.joints[0].turned_torque == doctest::Approx(95.0).epsilon(less_breakaway));
    CHECK(s.count("mistake") == 1);
}

TEST_CASE("Lesson: breakaway alone does not count as tightening torque") {
    Script s;
    s.seat_both();
    s.pull(0, 70.0);
    s.idle(2000);
    for (int i = 0; i < 20; ++i) break_away(s, 0, 70.0);  // a degree
    s.tick(0, servo::Grip::wrench, 10.0);
    s.idle();
    CHECK(s.lesson.joints[0].turned_torque < 71.0);
}

TEST_CASE(
    "Lesson: in assessment a joint left for the next counts as left, a brush does not, and the last is "
    "handed in") {
    Script s(Mode::assessment);
    s.seat_both();
    s.tick(0, servo::Grip::wrench, 0.3);
    s.idle();
    s.pull(1, 20.0);
    CHECK(s.lesson.current == 2);  // only brushed: still due
    s.pull(0, 20.0);
    CHECK(s.lesson.current == 2);
    CHECK(s.order_errors() == 1);
    s.pull(1, 35.0);
    CHECK(s.lesson.current == 4);
    CHECK(s.order_errors() == 1);  // leaving for the next is no error of order
    s.pull(0, 70.0);
    s.pull(1, 40.0);
    REQUIRE(s.lesson.current == 5);
    s.idle(2000);
    CHECK(s.lesson.current == 5);
    s.idle(1500);
    CHECK(s.lesson.due() == nullptr);
    CHECK(judge_joint(s.lesson, 1, s.state).overall == Verdict::low);
}

TEST_CASE("Lesson: the other modes never end a step that is not done") {
    for (const Mode mode : {Mode::guided, Mode::practice}) {
        Script s(mode);
        s.seat_both();
        s.pull(0, 20.0);
        s.pull(1, 35.0);
        s.idle(10'000);
        CHECK(s.lesson.current == 2);
    }
}

TEST_CASE("Lesson: a bolt that breaks keeps its torque, is named, and the lesson goes on") {
    Script s;
    s.seat_both();
    for (int i = 0; i <= 100; ++i) s.tick(0, servo::Grip::wrench, 1.2 * i, 1.0);
    s.state.joints[0].condition = joint::Condition::broken;
    s.tick(0, servo::Grip::wrench, 0.0);
    CHECK(s.lesson.current == 2);  // not before the hand lets go
    s.idle();
    CHECK(s.lesson.current == 3);
    CHECK(s.lesson.joints[0].result.torque == doctest::Approx(120.0));
    CHECK(judge_joint(s.lesson, 0, s.state).overall == Verdict::high);
    // Before it breaks it has had too much, and both are told.
    std::vector<Cause> causes;
    for (const Event& event : s.lesson.events)
        if (event.kind == "mistake") causes.push_back(event.cause);
    CHECK(causes == std::vector{Cause::over_torque, Cause::broken});
}

TEST_CASE("Lesson: fingers exchanged for the wrench without letting go are a new visit") {
    Script s;
    s.idle();
    s.tick(0, servo::Grip::fingers, 0.1, 1.0);
    s.tick(0, servo::Grip::wrench, 12.0);
    CHECK(s.lesson.grip == servo::Grip::wrench);
    CHECK(s.lesson.joints[0].snug);
    CHECK(s.count("engage") == 2);
}

TEST_CASE("Lesson: every pass is announced once, when it begins, with its share of the target") {
    Script s;
    s.seat_both();
    for (const double torque : {35.0, 70.0})
        for (const int joint : {0, 1}) s.pull(joint, torque);
    REQUIRE(s.lesson.due() == nullptr);
    std::vector<std::string> announced;
    int begun = 0;
    for (const Event& event : s.lesson.events) {
        begun += event.kind == "step_begin" ? 1 : 0;
        if (event.kind != "pass_begin") continue;
        CHECK(begun == 2 * static_cast<int>(announced.size()));  // before the first of its two steps
        announced.push_back(event.text);
    }
    CHECK(begun == 6);
    REQUIRE(announced.size() == 3);
    CHECK(announced[0] == "run down by hand");
    CHECK(announced[1] == "tighten to 50 %");
    CHECK(announced[2] == "tighten to 100 %");
}

TEST_CASE("Lesson: in assessment, the last joint left for another is out of turn: nothing follows it") {
    Script s(Mode::assessment);
    s.seat_both();
    for (const auto& [joint, torque] : {std::pair{0, 35.0}, {1, 35.0}, {0, 70.0}}) s.pull(joint, torque);
    REQUIRE(s.lesson.current == 5);
    s.pull(1, 40.0);
    s.pull(0, 70.0);
    CHECK(s.lesson.current == 5);
    CHECK(s.lesson.joints[0].result.rehits == 1);
}

TEST_CASE(
    "Lesson: more torque than the window is told once, and again only when the nut has been off its seat") {
    Script s;
    s.seat_both();
    s.pull(0, 76.9);
    CHECK(s.count("mistake") == 0);
    s.pull(1, 35.0);
    s.pull(0, 78.0);
    s.pull(0, 90.0);
    CHECK(s.count("mistake") == 2);  // the other is that it was done already
    CHECK(s.lesson.events.back().joint == 0);
    s.state.joints[0].stage = joint::Stage::navigation;
    s.tick(0, servo::Grip::wrench, -0.1, -1.0);
    s.state.joints[0].stage = joint::Stage::transition;
    s.idle();
    s.lesson.events.clear();
    s.pull(0, 90.0);
    int told = 0;
    for (const Event& event : s.lesson.events) told += event.cause == Cause::over_torque ? 1 : 0;
    CHECK(told == 1);
}

TEST_CASE("Lesson: breakaway alone is not told as too much") {
    Script s;
    s.seat_both();
    s.pull(0, 62.0);
    s.idle(2000);
    for (int i = 0; i < 20; ++i) break_away(s, 0, 75.0);  // a degree; the first with more than is right
    s.idle();
    CHECK(s.count("mistake") == 1);  // it was done already
    for (const Event& event : s.lesson.events) CHECK(event.cause != Cause::over_torque);
}
