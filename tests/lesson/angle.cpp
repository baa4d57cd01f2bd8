// Lessons that turn nuts by an angle from a mark, and loosening lessons that turn them back in rounds.
#include <doctest/doctest.h>

#include "game/lesson/judge.hpp"
#include "tests/lesson/played_session.hpp"
#include "tests/lesson/script.hpp"

namespace bolt::lesson::angle {

namespace {

using test::Script;

// A pass to half of the torque, then two that turn each nut to half and to the whole of 60°.
struct AngleScript : Script {
    explicit AngleScript(Mode mode = Mode::guided) : Script(mode, content::Strategy::torque_angle) {
        for (content::AssemblyJoint& joint : assembly.joints) {
            joint.spec.has_angle = true;
            joint.spec.angle = {to_radians(60.0), to_radians(50.0), to_radians(70.0)};
            joint.spec.torque = {70.0, 20.0, 120.0};
        }
        content::Pass whole{content::PassKind::turn, 1.0, {0, 1}}, half{content::PassKind::turn, 0.5, {0, 1}};
        assembly.passes = {assembly.passes[0], assembly.passes[1], half, whole};
        lesson = begin(assembly, mode, Task::tighten);
    }
    // Turns a nut by `degrees` at `torque` in N·m, then takes the wrench off.
    void turn(int joint, double degrees, double torque = 80.0) {
        const double speed = to_radians(degrees) / 0.1;
        for (int i = 0; i < 100; ++i) tick(joint, servo::Grip::wrench, torque, speed);
        state.joints[static_cast<std::size_t>(joint)].stage = joint::Stage::linearity;
        tick(joint, servo::Grip::wrench, torque);
        idle();
    }
    void to_the_turns() {
        seat_both();
        for (const int joint : {0, 1}) pull(joint, 35.0);
    }
    [[nodiscard]] std::vector<MistakeKind> mistakes() const {
        std::vector<MistakeKind> kinds;
        for (const LessonEvent& event : lesson.events)
            if (event.kind == EventKind::mistake) kinds.push_back(event.mistake);
        return kinds;
    }
};

// cover-m8, made snug and then turned by an angle.
content::Assembly cover_by_angle() {
    content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    content::Assembly cover = std::move(loaded.assembly);
    for (content::AssemblyJoint& joint : cover.joints) {
        joint.spec.strategy = content::Strategy::torque_angle;
        joint.spec.torque = {20.0, 8.0, 40.0};
        joint.spec.has_angle = true;
        joint.spec.angle = {to_radians(30.0), to_radians(20.0), to_radians(45.0)};
    }
    const auto& order = cover.passes.front().order;
    cover.passes = {{content::PassKind::run_down, 1.0, order},
                    {content::PassKind::tighten, 0.3, order},
                    {content::PassKind::turn, 0.5, order},
                    {content::PassKind::turn, 1.0, order}};
    cover.loosening = {{content::PassKind::loosen, 1.0, order, to_radians(30.0)},
                       {content::PassKind::loosen, 1.0, order}};
    return cover;
}

}  // namespace

TEST_CASE("Angle: an electronic torque wrench displays the angle from the mark, and the step's window") {
    AngleScript s;
    s.to_the_turns();
    REQUIRE(s.lesson.due()->kind == StepKind::turn);  // to half of 60°, 25° to 35°
    const auto reads = [&](double degrees) {
        for (int i = 0; i < 100; ++i) s.tick(0, servo::Grip::wrench, 80.0, to_radians(degrees) / 0.1);
        return tool_reading(s.lesson, s.components);
    };
    const ToolReading before = reads(20.0), inside = reads(10.0), beyond = reads(10.0);
    CHECK(before.value == doctest::Approx(20.0).epsilon(0.02));
    CHECK(before.target == world::TargetState::below);
    CHECK(inside.value == doctest::Approx(30.0).epsilon(0.02));
    CHECK(inside.target == world::TargetState::reached);
    CHECK(beyond.target == world::TargetState::exceeded);
}

TEST_CASE(
    "Angle: a step ends at the low edge of its share of the window, counted from where the nut rested") {
    AngleScript s;
    s.to_the_turns();
    REQUIRE(s.lesson.due()->kind == StepKind::turn);
    CHECK(s.lesson.due()->angle == doctest::Approx(to_radians(30.0)));
    const double mark = s.state.joints[0].nut.angle;
    CHECK(s.lesson.joints[0].mark == mark);
    CHECK(angle_window(s.assembly, *s.lesson.due()).low == doctest::Approx(to_radians(25.0)));
    s.turn(0, 24.0, 110.0);  // the torque does not end the step
    CHECK(s.lesson.due()->joint == 0);
    s.turn(0, 2.0);
    CHECK(s.lesson.due()->joint == 1);
    s.turn(1, 30.0);
    s.turn(0, 30.0);
    s.turn(1, 30.0);
    REQUIRE(s.lesson.due() == nullptr);
    CHECK(s.lesson.joints[0].mark == mark);  // one mark for both passes
    CHECK(s.judged(0).angle == doctest::Approx(to_radians(56.0)));
    CHECK(s.judged(0).overall == Verdict::ok);
    CHECK(s.judged(1).angle == doctest::Approx(to_radians(60.0)));
    CHECK(s.mistakes().empty());
}

TEST_CASE("Angle: turning too far is reported once and judged, and turning back corrects it") {
    AngleScript s;
    s.to_the_turns();
    s.turn(0, 30.0);
    s.turn(1, 30.0);
    s.turn(0, 45.0);
    CHECK(s.mistakes() == std::vector{MistakeKind::over_turned});
    CHECK(s.judged(0).angle_verdict == Verdict::high);
    CHECK(s.judged(0).overall == Verdict::high);
    s.turn(0, -15.0, -40.0);
    s.turn(0, 1.0, 40.0);
    CHECK(s.mistakes().size() <= 2);  // worked on again after its step, but not "the wrong way"
    for (const MistakeKind kind : s.mistakes()) CHECK(kind != MistakeKind::loosened);
    CHECK(s.judged(0).angle_verdict == Verdict::ok);
    s.turn(1, 30.0);
    const LessonResult result = judge(s.lesson, s.present(), 1e-3);
    int corrected = 0;
    for (const Deduction& reason : result.reasons)
        corrected += reason.kind == DeductionKind::over_turned ? 1 : 0;
    CHECK(corrected == 1);
}

TEST_CASE(
    "Angle: a nut that comes off its seat gets a new mark at the snug torque, so the step can be done") {
    AngleScript s;
    s.to_the_turns();
    s.turn(0, 10.0);
    s.state.joints[0].stage = joint::Stage::navigation;
    for (int i = 0; i < 100; ++i) s.tick(0, servo::Grip::wrench, -0.2, -4.0);
    s.idle();
    CHECK_FALSE(s.lesson.joints[0].mark.has_value());
    for (int i = 0; i < 100; ++i) s.tick(0, servo::Grip::wrench, 5.0, 4.0);
    CHECK_FALSE(s.lesson.joints[0].mark.has_value());  // below the snug torque
    s.state.joints[0].stage = joint::Stage::transition;
    s.turn(0, 26.0, 40.0);
    CHECK(s.lesson.joints[0].mark.has_value());
    CHECK(s.lesson.due()->joint == 1);
}

TEST_CASE("Angle: undoing a step restores its mark") {
    AngleScript s;
    s.to_the_turns();
    const std::optional<double> mark = s.lesson.joints[0].mark;
    s.turn(0, 30.0);
    REQUIRE(s.lesson.due()->joint == 1);
    REQUIRE(s.undo(1));
    CHECK(s.lesson.due()->joint == 0);
    REQUIRE(mark);
    CHECK(s.lesson.joints[0].mark == mark);
}

TEST_CASE("Angle: a loosening lesson turns every nut back before it loosens the first") {
    AngleScript s;
    s.assembly.loosening = {{content::PassKind::loosen, 1.0, {1, 0}, to_radians(45.0)},
                            {content::PassKind::loosen, 1.0, {0, 1}}};
    for (joint::JointState& joint : s.state.joints) joint.stage = joint::Stage::linearity;
    s.lesson = begin(s.assembly, Mode::guided, Task::loosen);
    s.idle();
    REQUIRE(s.lesson.steps.size() == 4);
    CHECK(s.lesson.due()->joint == 1);
    s.turn(1, -40.0, -60.0);
    CHECK(s.lesson.due()->joint == 1);
    s.turn(1, -6.0, -20.0);
    CHECK(s.lesson.due()->joint == 0);
    s.turn(0, -50.0, -60.0);
    REQUIRE(s.lesson.current == 2);
    s.turn(0, -90.0, -10.0);
    CHECK(s.lesson.current == 2);  // not free yet
    s.state.joints[0].stage = joint::Stage::navigation;
    s.tick(0, servo::Grip::wrench, -0.1, -1.0);
    s.idle();
    CHECK(s.lesson.current == 3);
    CHECK(s.judged(0).torque == doctest::Approx(60.0));  // of the round in which it broke loose
    CHECK(to_degrees(s.judged(0).angle) == doctest::Approx(140.0).epsilon(1e-3));
    CHECK(s.judged(0).overall == Verdict::ok);
    CHECK(s.mistakes().empty());
}

TEST_CASE(
    "Angle: every simulated trainee turns every nut into its window or is judged, and the session replays") {
    const content::Assembly cover = cover_by_angle();
    for (const Task task : {Task::tighten, Task::loosen})
        for (const char* profile : {"expert", "novice", "clumsy"}) {
            CAPTURE(profile);
            session::LessonOptions options;
            options.task = task;
            options.seed = 3;
            options.obstacles = session::ObstacleUse::none;
            const test::PlayedSession played =
                test::play_and_replay(cover, options, profile, test::setup_from_memory(cover, options));
            CHECK(played.result.finished);
            if (std::string(profile) == "expert") CHECK(played.result.score == 100.0);
            CHECK(played.mismatches == 0);
        }
}

}  // namespace bolt::lesson::angle
