// Lessons with a torque wrench: its set torque, its click, and its effect on trainees.

#include <doctest/doctest.h>

#include <algorithm>

#include "content/format/assembly.hpp"
#include "game/lesson/judge.hpp"
#include "game/lesson/law.hpp"
#include "game/lesson/step_requirements.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/lesson/played_session.hpp"
#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::Script;

namespace {

content::Assembly cover_with(const char* tool) {
    content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, tool));
    return std::move(loaded.assembly);
}

struct LessonRun {
    int in_window = 0, clicks = 0;
    double deviation = 0.0, worst_click = 0.0;  // relative to the trip torque
    bool finished = false;
};

LessonRun play_through(const content::Assembly& assembly, const char* trainee, std::uint64_t seed,
                       joint::Law law = joint::Law::mechanistic) {
    const content::Assembly under = apply_law(assembly, law);
    const servo::Setup setup = session::make_setup(under, law, {}, seed, 1e-3);
    servo::State state = servo::initial_state(setup);
    world::World world = test::make_world(state);
    Lesson lesson = begin(under, Mode::practice, Task::tighten);
    trainees::SimulatedTrainee hand(trainees::find_profile(trainee).value(), seed, setup);
    LessonRun run;
    run.deviation = setup.wrench.deviation;
    while (lesson.due() != nullptr && state.tick < 1'200'000) {
        servo::TickInput input = hand.act(setup, state, lesson);
        input.set_torque = static_cast<float>(wrench_set_torque(lesson));
        const double trips = wrench_set_torque(lesson) * setup.wrench.adaptor_ratio * (1.0 + run.deviation);
        const servo::Output output = servo::tick(setup, state, input);
        if (output.clicked) {
            ++run.clicks;
            run.worst_click = std::max(run.worst_click, output.wrench_torque / trips - 1.0);
        }
        test::observe_tick(lesson, world, state, output);
        lesson.events.clear();
    }
    run.finished = lesson.due() == nullptr;
    for (const JointResult& joint : judge(lesson, world, 1e-3).joints)
        run.in_window += joint.torque_verdict == Verdict::ok ? 1 : 0;
    return run;
}

}  // namespace

TEST_CASE("Torque wrench: set to the step's torque, and to 0 for steps without a torque") {
    Script plain;
    plain.seat(0);
    plain.seat(1);
    CHECK(plain.lesson.due()->kind == StepKind::tighten);
    CHECK(wrench_set_torque(plain.lesson) == 0.0);  // a plain wrench has no scale
    Script s;
    s.take_torque_wrench();
    s.idle();
    CHECK(wrench_set_torque(s.lesson) == 0.0);  // run down
    s.seat(0);
    s.seat(1);
    CHECK(wrench_set_torque(s.lesson) == 35.0);
    s.pull(0, 35.0);
    s.pull(1, 35.0);
    CHECK(wrench_set_torque(s.lesson) == 70.0);
    s.pull(0, 70.0);
    s.pull(1, 70.0);
    CHECK(wrench_set_torque(s.lesson) == 0.0);  // all steps are done
}

TEST_CASE("Torque wrench: with an adaptor the scale is set lower, and the joints get their torque") {
    content::Assembly assembly = cover_with("torque_wrench");
    assembly.wrench.handle_length = 0.2;
    assembly.wrench.adaptor_length = 0.04;
    const LessonRun expert = play_through(assembly, "expert", 3);
    CHECK(expert.finished);
    CHECK(expert.in_window == 4);
    CHECK(expert.clicks >= 8);
    Lesson lesson = begin(assembly, Mode::practice, Task::tighten);
    while (lesson.due()->kind != StepKind::tighten || lesson.due()->fraction < 1.0) ++lesson.current;
    CHECK(wrench_set_torque(lesson) == doctest::Approx(16.0));  // 20 N·m · 160 / 200
    session::LessonOptions options;
    options.seed = 3;
    const test::PlayedSession played =
        test::play_and_replay(assembly, options, "expert", test::setup_from_memory(assembly, options));
    CHECK(played.mismatches == 0);
    CHECK(played.result.score == 100.0);
}

TEST_CASE("Torque wrench: an electronic one displays the torque on its scale, and where the step stands") {
    Script s;
    s.idle();
    CHECK(tool_reading(s.lesson, s.components).value == 0.0);
    s.seat_both();
    const auto reads = [&](double torque) {
        s.tick(0, servo::Grip::wrench, torque);
        return tool_reading(s.lesson, s.components);
    };
    CHECK(reads(20.0).value == doctest::Approx(20.0));
    CHECK(reads(20.0).target == world::TargetState::below);
    CHECK(reads(35.0).target == world::TargetState::reached);
    CHECK(reads(50.0).target == world::TargetState::exceeded);
    s.assembly.wrench.handle_length = 0.3;
    s.assembly.wrench.adaptor_length = 0.06;
    CHECK(reads(35.0).value == doctest::Approx(28.0));  // 240 / 300
    CHECK(reads(35.0).target == world::TargetState::reached);
}

TEST_CASE("Torque wrench: a click gives one event with its torque") {
    Script s;
    s.seat_both();
    s.tick(0, servo::Grip::wrench, 34.5, 0.0, true);
    for (int i = 0; i < 50; ++i) s.tick(0, servo::Grip::wrench, 17.0);
    CHECK(s.count(EventKind::click) == 1);
    for (const LessonEvent& event : s.lesson.events)
        if (event.kind == EventKind::click) {
            CHECK(event.joint == 0);
            CHECK(event.value == 34.5);
        }
}

TEST_CASE("Torque wrench: with strategy yield a click completes its step, and no later one") {
    Script s(Mode::guided, content::Strategy::yield);
    s.take_torque_wrench();
    s.seat_both();
    for (const int joint : {0, 1}) {
        s.tick(joint, servo::Grip::wrench, 35.0, 0.0, true);
        s.pull(joint, 35.0);
    }
    REQUIRE(s.lesson.current == 4);
    s.pull(0, 70.0);
    CHECK(s.lesson.current == 4);
    s.tick(0, servo::Grip::wrench, 70.0, 0.0, true);
    s.idle();
    CHECK(s.lesson.current == 5);
}

TEST_CASE("Torque wrench: pulling on past the click is excess torque and is reported") {
    Script s;
    s.take_torque_wrench();
    s.seat_both();
    for (const int joint : {0, 1}) s.pull(joint, 35.0);
    s.tick(0, servo::Grip::wrench, 70.0, 0.0, true);
    s.pull(0, 90.0);
    CHECK(s.count(EventKind::mistake) == 1);
    CHECK(s.judged(0).torque_verdict == Verdict::high);
}

TEST_CASE("Torque wrench: trainees stop at the click under both laws, and tighten more accurately with it") {
    const content::Assembly plain = cover_with("wrench"), torque = cover_with("torque_wrench");
    for (const joint::Law law : {joint::Law::mechanistic, joint::Law::published}) {
        const LessonRun expert = play_through(torque, "expert", 3, law);
        CHECK(expert.finished);
        CHECK(expert.in_window == 4);
        CHECK(expert.clicks >= 8);
        CHECK(expert.worst_click <= 1e-9);
    }
    const content::LoadedAssembly reducer = content::load_assembly("zq350");
    REQUIRE(reducer.ok());
    content::Assembly clicking = reducer.assembly;
    REQUIRE(content::choose_tool(clicking, "torque_wrench").has_value());
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {  // wrenches that read too high and too low
        const LessonRun expert = play_through(clicking, "expert", seed, joint::Law::published);
        CHECK(expert.finished);
        CHECK(expert.in_window == 12);
        CHECK(expert.clicks >= 36);  // three rounds
    }
    int with = 0, without = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const LessonRun clicked = play_through(torque, "novice", seed);
        const LessonRun felt = play_through(plain, "novice", seed);
        CHECK(clicked.finished);
        CHECK(felt.clicks == 0);
        CHECK(std::abs(clicked.deviation) <= 0.04);
        with += clicked.in_window;
        without += felt.in_window;
    }
    MESSAGE("novices, of 40 nuts in their window: ", without, " by feel, ", with, " by the click");
    CHECK(with > without);
    CHECK(with >= 36);
}
