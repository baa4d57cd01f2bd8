// The lesson's state machine with scripted ticks.

#include <doctest/doctest.h>

#include <algorithm>

#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::Script;

namespace {

// Remaining breakaway after a long turn, relative.
constexpr double less_breakaway = 0.005;

// One tick of a nut that turns with `torque`, and needs more until it has broken away.
void break_away(Script& s, std::size_t joint, double running) {
    const double ratio = s.lesson.assembly->joints[joint].design.friction.static_ratio;
    s.tick(static_cast<int>(joint), servo::Grip::wrench,
           running * (1.0 + (ratio - 1.0) * s.state.joints[joint].breakaway), 1.0);
}

}  // namespace

TEST_CASE("Lesson: a nut off its seat is not run down") {
    Script s;
    s.idle();
    s.tick(0, servo::Grip::fingers, 0.1, 1.0);
    s.idle();
    CHECK(s.lesson.current == 0);
    s.seat(0);
    CHECK(s.lesson.current == 1);
}

TEST_CASE(
    "Lesson: a tightening step stays due below the window's low edge and ends with the release above it") {
    Script s;
    s.seat_both();
    REQUIRE(s.lesson.current == 2);
    s.pull(0, 31.0);  // half of 63 is 31.5
    CHECK(s.lesson.current == 2);
    s.pull(0, 32.0);
    CHECK(s.lesson.current == 3);
}

TEST_CASE("Lesson: a step ends when the hand releases the nut, not before") {
    Script s;
    s.seat_both();
    for (int i = 0; i <= 100; ++i) s.tick(0, servo::Grip::wrench, 0.4 * i, 1.0);
    CHECK(s.lesson.current == 2);
    s.idle();
    CHECK(s.lesson.current == 3);
}

TEST_CASE("Lesson: with strategy yield a full step needs yield or a torque above the window") {
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
    "Lesson: work out of turn is reported once a hold, work on a done joint as done already, a touch not at "
    "all") {
    Script s;
    s.seat_both();
    s.tick(1, servo::Grip::wrench, 0.2);
    s.idle();
    CHECK(s.lesson.joints[1].result.out_of_turn == 0);
    s.pull(1, 20.0);
    CHECK(s.lesson.joints[1].result.out_of_turn == 1);
    s.pull(0, 35.0);
    s.pull(0, 36.0);
    CHECK(s.lesson.joints[0].result.done_already == 1);
    CHECK(s.count(EventKind::mistake) == 2);
}

TEST_CASE("Lesson: spinning a nut out of turn with several grips is one mistake") {
    Script s;
    s.idle();
    const auto grips = [&s](int times) {
        for (int i = 0; i < times; ++i) {
            for (int k = 0; k < 300; ++k) s.tick(1, servo::Grip::fingers, 0.1, 1.0);
            s.idle(150);
        }
    };
    grips(5);
    CHECK(s.lesson.joints[1].result.out_of_turn == 1);
    s.idle(1000);
    grips(2);
    CHECK(s.lesson.joints[1].result.out_of_turn == 2);
}

TEST_CASE("Lesson: checking a seated nut with the fingers is no mistake, with the wrench it is") {
    Script s;
    s.seat(0);
    REQUIRE(s.lesson.current == 1);
    s.tick(0, servo::Grip::fingers, 0.6);
    s.idle();
    CHECK(s.count(EventKind::mistake) == 0);
    CHECK(s.lesson.joints[0].result.done_already == 0);
    s.pull(0, 5.0);
    CHECK(s.lesson.joints[0].result.done_already == 1);
    CHECK(s.lesson.current == 1);
}

TEST_CASE(
    "Lesson: checking the last nut after the next pass began is no mistake; taking a nut off its seat is") {
    Script s;
    s.seat_both();
    REQUIRE(s.lesson.due()->joint == 0);
    s.tick(1, servo::Grip::fingers, 0.6);
    s.idle();
    CHECK(s.count(EventKind::mistake) == 0);
    s.state.joints[1].stage = joint::Stage::navigation;
    s.idle(1000);
    s.tick(1, servo::Grip::fingers, 0.1, 1.0);
    s.idle();
    CHECK(s.lesson.joints[1].result.out_of_turn == 1);
}

TEST_CASE("Lesson: turning a nut back from its seat is reported once a hold, and play is not") {
    const auto reported = [](const Script& s, MistakeKind kind) {
        return std::count_if(s.lesson.events.begin(), s.lesson.events.end(),
                             [&](const LessonEvent& event) { return event.mistake == kind; });
    };
    // A hold that turns the nut on by some degrees, then back.
    const auto hold = [](Script& s, double on, double back, servo::Grip grip = servo::Grip::wrench) {
        for (int i = 0; i < 100; ++i) s.tick(0, grip, 5.0, to_radians(10.0 * on));
        for (int i = 0; i < 100; ++i) s.tick(0, grip, -5.0, to_radians(-10.0 * back));
        s.idle();
    };
    Script s;
    s.seat_both();
    hold(s, 20.0, 4.0);
    CHECK(reported(s, MistakeKind::loosened) == 0);
    hold(s, 0.0, 20.0);
    CHECK(reported(s, MistakeKind::loosened) == 1);
    hold(s, 20.0, 30.0);
    CHECK(reported(s, MistakeKind::loosened) == 2);
    s.state.joints[0].stage = joint::Stage::navigation;  // off its seat, and still turning
    hold(s, 0.0, 40.0);
    CHECK(reported(s, MistakeKind::loosened) == 2);
    CHECK(s.lesson.joints[0].wrong_way_count == 2);

    SUBCASE("not after excess torque") {
        Script slackened;
        slackened.seat_both();
        slackened.pull(0, 90.0);
        hold(slackened, 0.0, 20.0);
        CHECK(reported(slackened, MistakeKind::over_torque) == 1);
        CHECK(reported(slackened, MistakeKind::loosened) == 0);
    }
    SUBCASE("in a loosening lesson the directions are swapped") {
        Script off;
        off.state.joints[0].stage = joint::Stage::linearity;
        off.lesson = begin(off.assembly, Mode::guided, Task::loosen);
        hold(off, -30.0, 0.0);
        CHECK(reported(off, MistakeKind::tightened) == 0);
        hold(off, 20.0, 0.0);
        CHECK(reported(off, MistakeKind::tightened) == 1);
        CHECK(reported(off, MistakeKind::loosened) == 0);
    }
}

TEST_CASE("Lesson: excess torque outside the joint's step counts in its result") {
    Script s;
    s.seat_both();
    s.pull(0, 95.0);
    s.pull(1, 35.0);
    s.pull(0, 70.0);
    s.pull(1, 70.0);
    REQUIRE(s.lesson.due() == nullptr);
    CHECK(s.judged(0).torque == doctest::Approx(95.0).epsilon(less_breakaway));
    CHECK(s.judged(0).overall == Verdict::high);
    CHECK(s.judged(1).overall == Verdict::ok);
}

TEST_CASE("Lesson: a nut that leaves its seat resets torque, snug and yield") {
    Script s;
    s.seat_both();
    s.pull(0, 95.0);
    s.state.joints[0].stage = joint::Stage::navigation;
    s.tick(0, servo::Grip::wrench, -0.1, -1.0);
    CHECK_FALSE(s.lesson.joints[0].mark.has_value());
    CHECK(s.lesson.joints[0].turned_torque == 0.0);
    s.idle();
    s.state.joints[0].stage = joint::Stage::transition;
    const double before = s.state.joints[0].nut.angle;
    s.pull(0, 70.0);
    CHECK(s.lesson.joints[0].mark > before);
    CHECK(s.judged(0).torque == doctest::Approx(70.0).epsilon(less_breakaway));
}

TEST_CASE("Lesson: turning a nut in short movements counts as turning") {
    Script s;
    s.seat_both();
    for (int frame = 0; frame < 60; ++frame)  // as with a mouse: in increments below 1°
        for (int i = 0; i < 16; ++i) s.tick(0, servo::Grip::wrench, 95.0, i < 8 ? 0.8 : 0.0);
    s.tick(0, servo::Grip::wrench, 10.0);
    s.idle();
    CHECK(s.lesson.joints[0].turned_torque == doctest::Approx(95.0).epsilon(less_breakaway));
    CHECK(s.count(EventKind::mistake) == 1);
}

TEST_CASE("Lesson: breakaway alone does not count as tightening torque") {
    Script s;
    s.seat_both();
    s.pull(0, 70.0);
    s.idle(2000);
    for (int i = 0; i < 20; ++i) break_away(s, 0, 70.0);  // 1° in all
    s.tick(0, servo::Grip::wrench, 10.0);
    s.idle();
    CHECK(s.lesson.joints[0].turned_torque < 71.0);
}

TEST_CASE(
    "Lesson: in assessment, working on the next joint ends a step, a touch does not, and a pause ends the "
    "last") {
    Script s(Mode::assessment);
    s.seat_both();
    s.tick(0, servo::Grip::wrench, 0.3);
    s.idle();
    s.pull(1, 20.0);
    CHECK(s.lesson.current == 2);  // only touched, so the step is still due
    s.pull(0, 20.0);
    CHECK(s.lesson.current == 2);
    CHECK(s.out_of_turn() == 1);
    s.pull(1, 35.0);
    CHECK(s.lesson.current == 4);
    CHECK(s.out_of_turn() == 1);  // continuing with the next joint is in order
    s.pull(0, 70.0);
    s.pull(1, 40.0);
    REQUIRE(s.lesson.current == 5);
    s.idle(2000);
    CHECK(s.lesson.current == 5);
    s.idle(1500);
    CHECK(s.lesson.due() == nullptr);
    CHECK(s.judged(1).overall == Verdict::low);
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

TEST_CASE("Lesson: a broken bolt keeps its torque and is reported, and the lesson continues") {
    Script s;
    s.seat_both();
    for (int i = 0; i <= 100; ++i) s.tick(0, servo::Grip::wrench, 1.2 * i, 1.0);
    s.state.joints[0].condition = joint::JointCondition::broken;
    s.tick(0, servo::Grip::wrench, 0.0);
    CHECK(s.lesson.current == 2);  // not before the release
    s.idle();
    CHECK(s.lesson.current == 3);
    CHECK(s.lesson.joints[0].result.torque == doctest::Approx(120.0));
    CHECK(s.judged(0).overall == Verdict::high);
    // Excess torque precedes the break, and both are reported.
    std::vector<MistakeKind> kinds;
    for (const LessonEvent& event : s.lesson.events)
        if (event.kind == EventKind::mistake) kinds.push_back(event.mistake);
    CHECK(kinds == std::vector{MistakeKind::over_torque, MistakeKind::broken});
}

TEST_CASE("Lesson: changing from fingers to wrench without a release is a new hold") {
    Script s;
    s.idle();
    s.tick(0, servo::Grip::fingers, 0.1, 1.0);
    s.tick(0, servo::Grip::wrench, 12.0);
    CHECK(s.lesson.grip == servo::Grip::wrench);
    CHECK(s.lesson.joints[0].mark.has_value());
    CHECK(s.count(EventKind::engage) == 2);
}

TEST_CASE("Lesson: every pass is announced once, at its start, with its share of the target") {
    Script s;
    s.seat_both();
    for (const double torque : {35.0, 70.0})
        for (const int joint : {0, 1}) s.pull(joint, torque);
    REQUIRE(s.lesson.due() == nullptr);
    std::vector<std::string> announced;
    int begun = 0;
    for (const LessonEvent& event : s.lesson.events) {
        begun += event.kind == EventKind::step_begin ? 1 : 0;
        if (event.kind != EventKind::pass_begin) continue;
        CHECK(begun == 2 * static_cast<int>(announced.size()));  // before the first of its two steps
        announced.push_back(event.text);
    }
    CHECK(begun == 6);
    REQUIRE(announced.size() == 3);
    CHECK(announced[0] == "run down by hand");
    CHECK(announced[1] == "tighten to 50 %");
    CHECK(announced[2] == "tighten to 100 %");
}

TEST_CASE("Lesson: in assessment, leaving the last joint for another one is out of turn") {
    Script s(Mode::assessment);
    s.seat_both();
    for (const auto& [joint, torque] : {std::pair{0, 35.0}, {1, 35.0}, {0, 70.0}}) s.pull(joint, torque);
    REQUIRE(s.lesson.current == 5);
    s.pull(1, 40.0);
    s.pull(0, 70.0);
    CHECK(s.lesson.current == 5);
    CHECK(s.lesson.joints[0].result.done_already == 1);
}

TEST_CASE("Lesson: excess torque is reported once, and again only after the nut was off its seat") {
    Script s;
    s.seat_both();
    s.pull(0, 76.9);
    CHECK(s.count(EventKind::mistake) == 0);
    s.pull(1, 35.0);
    s.pull(0, 78.0);
    s.pull(0, 90.0);
    CHECK(s.count(EventKind::mistake) == 2);  // the other is work on a finished joint
    CHECK(s.lesson.events.back().joint == 0);
    s.state.joints[0].stage = joint::Stage::navigation;
    s.tick(0, servo::Grip::wrench, -0.1, -1.0);
    s.state.joints[0].stage = joint::Stage::transition;
    s.idle();
    s.lesson.events.clear();
    s.pull(0, 90.0);
    int reported = 0;
    for (const LessonEvent& event : s.lesson.events)
        reported += event.mistake == MistakeKind::over_torque ? 1 : 0;
    CHECK(reported == 1);
}

TEST_CASE("Lesson: breakaway alone is not reported as excess torque") {
    Script s;
    s.seat_both();
    s.pull(0, 62.0);
    s.idle(2000);
    for (int i = 0; i < 20; ++i) break_away(s, 0, 75.0);  // 1° in all; the first tick exceeds the window
    s.idle();
    CHECK(s.count(EventKind::mistake) == 1);  // done already
    for (const LessonEvent& event : s.lesson.events) CHECK(event.mistake != MistakeKind::over_torque);
}
