// Undo and "begin this step again": the lesson's side of it.

#include <doctest/doctest.h>

#include "content/format/assembly.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::Script;

namespace {

bool same(const JointTrack& a, const JointTrack& b) {
    return a.result.torque == b.result.torque && a.result.angle == b.result.angle &&
           a.result.strokes == b.result.strokes && a.snug == b.snug && a.snug_angle == b.snug_angle &&
           a.peak_torque == b.peak_torque && a.turned_torque == b.turned_torque &&
           a.begin_angle == b.begin_angle && a.yielded == b.yielded && a.overdone == b.overdone &&
           a.done_in_pass == b.done_in_pass;
}

void work(Script& s) {
    const auto joint = static_cast<int>(s.lesson.due()->joint);
    if (s.lesson.current < 2)
        s.seat(joint);
    else
        s.pull(joint, s.lesson.current < 4 ? 35.0 : 95.0);
}

// What is known of the joints, and how they are.
struct Moment {
    std::vector<JointTrack> tracks;
    std::vector<joint::JointState> joints;
};

// Plays to the end; a moment for the beginning of every step, and one for the end.
std::vector<Moment> play_through(Script& s) {
    std::vector<Moment> moments;
    while (s.lesson.due() != nullptr) {
        moments.push_back({s.lesson.joints, s.state.joints});
        const std::size_t step = s.lesson.current;
        work(s);
        REQUIRE(s.lesson.current == step + 1);
    }
    moments.push_back({s.lesson.joints, s.state.joints});
    return moments;
}

}  // namespace

TEST_CASE("Undo: a step that is gone back to knows of the joints what it knew when it began") {
    for (std::size_t steps = 1; steps <= 6; ++steps) {
        CAPTURE(steps);
        Script s;
        s.idle();
        const std::vector<Moment> moments = play_through(s);
        REQUIRE(moments.size() == 7);
        const std::size_t to = 6 - steps;
        s.state.joints = moments[to].joints;
        REQUIRE(back(s.lesson, s.state, steps));
        CHECK(s.lesson.current == to);
        for (std::size_t i = 0; i < 2; ++i) CHECK(same(s.lesson.joints[i], moments[to].tracks[i]));
        // And from there it goes on as it did.
        const std::vector<Moment> again = play_through(s);
        REQUIRE(again.size() == steps + 1);
        for (std::size_t i = 0; i < 2; ++i) CHECK(same(again.back().tracks[i], moments.back().tracks[i]));
    }
}

TEST_CASE(
    "Undo: what was pulled too far is as if not done once its step is taken back, and costs points all the "
    "same") {
    Script s;
    s.seat_both();
    const auto before = s.state.joints;
    s.pull(0, 95.0);
    CHECK(judge_joint(s.lesson, 0, s.state).overall == Verdict::high);
    s.state.joints = before;
    REQUIRE(back(s.lesson, s.state, 1));
    CHECK(s.lesson.due()->joint == 0);
    s.pull(0, 35.0);
    s.pull(1, 35.0);
    s.pull(0, 70.0);
    s.pull(1, 70.0);
    REQUIRE(s.lesson.due() == nullptr);
    CHECK(judge_joint(s.lesson, 0, s.state).overall == Verdict::ok);
    const LessonResult result = judge(s.lesson, s.state, 1e-3);
    REQUIRE(result.reasons.size() == 1);
    CHECK(result.reasons[0].fault == Fault::overdone);
    CHECK(result.score == 98.0);
}

TEST_CASE("Undo: mistakes stay counted, and events tell what happened") {
    Script s;
    s.seat_both();
    s.pull(1, 20.0);  // out of turn
    s.pull(0, 35.0);
    s.pull(0, 36.0);  // done already
    s.lesson.events.clear();
    s.tick(1, servo::Grip::wrench, 5.0);
    REQUIRE(back(s.lesson, s.state, 3));
    CHECK(s.lesson.joints[1].result.order_errors == 1);
    CHECK(s.lesson.joints[0].result.rehits == 1);
    std::vector<std::string> kinds;
    for (const Event& event : s.lesson.events) kinds.push_back(event.kind);
    // From the second pass into the first: that is announced again.
    CHECK(kinds == std::vector<std::string>{"engage", "release", "back", "pass_begin", "step_begin"});
    const Event& told = s.lesson.events[2];
    CHECK(told.joint == 0);
    CHECK(told.value == 3.0);
    CHECK(told.text == "back to step 1 of 6");
    CHECK(s.lesson.held == -1);
    // The hand is still on the nut: that is a new visit.
    s.tick(1, servo::Grip::wrench, 5.0);
    CHECK(s.lesson.joints[1].result.order_errors == 2);
}

TEST_CASE("Undo: a step begun anew is the same step, announces no pass, and forgets its pulls") {
    Script s;
    s.seat_both();
    s.pull(0, 20.0);
    CHECK(s.lesson.joints[0].result.strokes == 1);
    const int passes = s.count("pass_begin");
    REQUIRE(back(s.lesson, s.state, 0));
    CHECK(s.lesson.current == 2);
    CHECK(s.lesson.joints[0].peak_torque == 0.0);
    CHECK(s.lesson.joints[0].result.strokes == 0);
    CHECK(s.count("pass_begin") == passes);
    s.pull(0, 20.0);
    CHECK(s.lesson.current == 2);
    s.pull(0, 32.0);
    CHECK(s.lesson.current == 3);
}

TEST_CASE("Undo: there is no way back in assessment, before the first step, or from the end into nothing") {
    Script examined(Mode::assessment);
    examined.seat_both();
    const std::size_t told = examined.lesson.events.size();
    CHECK_FALSE(back(examined.lesson, examined.state, 1));
    CHECK(examined.lesson.current == 2);
    CHECK(examined.lesson.events.size() == told);

    Script s;
    CHECK_FALSE(back(s.lesson, s.state, 0));  // it has not begun
    s.seat_both();
    CHECK_FALSE(back(s.lesson, s.state, 3));
    CHECK(s.lesson.current == 2);
    for (const double torque : {35.0, 70.0})
        for (const int joint : {0, 1}) s.pull(joint, torque);
    REQUIRE(s.lesson.due() == nullptr);
    CHECK_FALSE(back(s.lesson, s.state, 0));
    CHECK(back(s.lesson, s.state, 1));
    CHECK(s.lesson.current == 5);
}

TEST_CASE("Undo: from every step back, joints put back or not, a simulated trainee comes to the end") {
    const content::Loaded loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    const content::Assembly& assembly = loaded.assembly;
    const servo::Setup setup = session::make_setup(assembly, joint::Law::mechanistic, {}, 5, 1e-3);
    for (const Task task : {Task::tighten, Task::loosen})
        for (const bool restored : {true, false}) {
            servo::State state = servo::initial_state(setup);
            if (task == Task::loosen) REQUIRE(session::pretighten(assembly, setup, state).has_value());
            Lesson lesson = begin(assembly, Mode::guided, task);
            trainees::Operator hand(trainees::find_profile("expert").value(), 5, setup);
            std::vector<std::vector<joint::JointState>> before{state.joints};
            std::size_t furthest = 0;
            int backs = 0;
            // It takes two steps forward and one back, until the end.
            while (lesson.due() != nullptr && state.tick < 3'600'000) {
                const servo::Output output = servo::tick(setup, state, hand.act(setup, state, lesson));
                observe(lesson, state, output);
                before.resize(std::min(before.size(), lesson.current + 1));
                if (before.size() == lesson.current) before.push_back(state.joints);
                if (lesson.current > furthest) {
                    furthest = lesson.current;
                    const std::size_t steps = furthest % 3 == 0 ? 2 : 1;
                    if (furthest < steps) continue;
                    if (restored) state.joints = before[furthest - steps];
                    REQUIRE(back(lesson, state, steps));
                    ++backs;
                }
            }
            CAPTURE(static_cast<int>(task));
            CAPTURE(restored);
            CHECK(lesson.due() == nullptr);
            CHECK(backs == static_cast<int>(lesson.steps.size()));
            for (const JointResult& joint : judge(lesson, state, 1e-3).joints) {
                CAPTURE(joint.id);
                if (restored) CHECK(joint.overall == Verdict::ok);
            }
        }
}
