// Every verdict and every deduction, for lessons with tracks set by the test.

#include <doctest/doctest.h>

#include <initializer_list>

#include "game/lesson/judge.hpp"
#include "game/lesson/lesson.hpp"
#include "tests/support/haptic_world.hpp"

using namespace bolt;
using namespace bolt::lesson;

namespace {

struct Bench {
    content::Assembly assembly;
    Lesson lesson;
    servo::State state;

    explicit Bench(std::size_t joints = 4, Mode mode = Mode::guided, Task task = Task::tighten) {
        content::Pass pass;
        for (std::size_t i = 0; i < joints; ++i) {
            content::AssemblyJoint joint;
            joint.design.id = "B" + std::to_string(i + 1);
            joint.spec.torque = {70.0, 60.0, 80.0};
            joint.spec.snug_torque = 10.0;
            joint.spec.has_angle = true;
            joint.spec.angle = {0.5, 0.3, 0.8};
            assembly.joints.push_back(joint);
            pass.order.push_back(i);
        }
        pass.kind = content::PassKind::tighten;
        assembly.passes = {pass};
        lesson = begin(assembly, mode, task);
        state.joints.resize(joints);
        state.rounded.resize(joints);
        for (std::size_t i = 0; i < joints; ++i) done(i, 70.0, 0.5);
        lesson.current = lesson.steps.size();
    }

    void done(std::size_t i, double torque, double angle) {
        lesson.joints[i].result.torque = torque;
        lesson.joints[i].result.angle = angle;
        state.joints[i].stage = joint::Stage::linearity;
        state.joints[i].clamp = 30e3;
    }
    [[nodiscard]] JointResult joint(std::size_t i = 0) const {
        return judge_joint(lesson, i, test::make_world(state));
    }
    [[nodiscard]] LessonResult result() const { return judge(lesson, test::make_world(state), 1e-3); }
};

}  // namespace

TEST_CASE("Judge: torque and angle are each LOW, OK or HIGH, and the worse of the two counts") {
    struct Case {
        double torque, angle;
        Verdict torque_verdict, angle_verdict, overall;
    };
    constexpr Verdict low = Verdict::low, ok = Verdict::ok, high = Verdict::high;
    for (const Case& c : std::initializer_list<Case>{{70.0, 0.5, ok, ok, ok},
                                                     {59.9, 0.5, low, ok, low},
                                                     {80.1, 0.5, high, ok, high},
                                                     {60.0, 0.3, ok, ok, ok},
                                                     {80.0, 0.8, ok, ok, ok},
                                                     {70.0, 0.29, ok, low, low},
                                                     {70.0, 0.81, ok, high, high},
                                                     {59.9, 0.81, low, high, high}}) {
        CAPTURE(c.torque);
        CAPTURE(c.angle);
        Bench bench;
        bench.done(0, c.torque, c.angle);
        const JointResult r = bench.joint();
        CHECK(r.torque_verdict == c.torque_verdict);
        CHECK(r.angle_verdict == c.angle_verdict);
        CHECK(r.overall == c.overall);
    }
}

TEST_CASE("Judge: without an angle window no angle is judged") {
    Bench bench;
    bench.assembly.joints[0].spec.has_angle = false;
    bench.done(0, 70.0, 9.0);
    CHECK(bench.joint().angle_verdict == Verdict::none);
    CHECK(bench.joint().overall == Verdict::ok);
}

TEST_CASE("Judge: a joint off its seat, broken or stripped is not OK, whatever its torque was") {
    Bench bench;
    bench.state.joints[0].stage = joint::Stage::navigation;
    CHECK(bench.joint().overall == Verdict::low);
    for (const joint::JointCondition condition :
         {joint::JointCondition::broken, joint::JointCondition::stripped}) {
        Bench damaged;
        damaged.state.joints[1].condition = condition;
        CHECK(damaged.joint(1).overall == Verdict::high);
        CHECK(damaged.joint(1).condition == condition);
    }
}

TEST_CASE("Judge: later torques that turn the nut count too") {
    Bench bench;
    bench.lesson.joints[0].turned_torque = 95.0;
    CHECK(bench.joint().torque == 95.0);
    CHECK(bench.joint().torque_verdict == Verdict::high);
}

TEST_CASE("Judge: every deduction has a reason, and the score is at least 0") {
    CHECK(Bench().result().score == 100.0);
    CHECK(Bench().result().reasons.empty());
    CHECK(Bench().result().finished);

    Bench one;
    one.done(0, 50.0, 0.5);
    CHECK(one.result().score == doctest::Approx(75.0));  // one of four
    REQUIRE(one.result().reasons.size() == 1);
    CHECK(one.result().reasons[0].points == doctest::Approx(-25.0));
    CHECK(one.result().reasons[0].text.find("B1") != std::string::npos);

    Bench broken;
    broken.state.joints[2].condition = joint::JointCondition::broken;
    CHECK(broken.result().score == doctest::Approx(62.5));  // one and a half

    Bench untidy;
    untidy.lesson.joints[0].result.out_of_turn = 2;
    untidy.lesson.joints[3].result.done_already = 3;
    CHECK(untidy.result().score == doctest::Approx(100.0 - 4.0 - 3.0));
    CHECK(untidy.result().reasons.size() == 2);

    Bench all;
    for (std::size_t i = 0; i < 4; ++i) all.state.joints[i].condition = joint::JointCondition::broken;
    CHECK(all.result().score == 0.0);

    Bench left;
    left.lesson.current = 1;
    CHECK_FALSE(left.result().finished);
    CHECK(left.result().reasons.back().text == "the lesson was left at step 2 of 4");
}

TEST_CASE("Judge: duration is ticks times dt") {
    Bench bench;
    bench.state.tick = 4500;
    CHECK(bench.result().duration == doctest::Approx(4.5));
}
