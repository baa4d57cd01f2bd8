// Lessons with a torque wrench: what it is set to, what its click ends, and what it does for trainees.

#include <doctest/doctest.h>

#include <algorithm>

#include "content/format/assembly.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::Script;

namespace {

content::Assembly cover_with(const char* tool) {
    content::Loaded loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    REQUIRE(content::choose_tool(loaded.assembly, tool));
    return std::move(loaded.assembly);
}

struct Played {
    int in_window = 0, clicks = 0;
    double deviation = 0.0, worst_click = 0.0;  // relative, beside what the tool trips at
    bool finished = false;
};

Played play_through(const content::Assembly& assembly, const char* trainee, std::uint64_t seed,
                    joint::Law law = joint::Law::mechanistic) {
    const content::Assembly under = under_law(assembly, law);
    const servo::Setup setup = session::make_setup(under, law, {}, seed, 1e-3);
    servo::State state = servo::initial_state(setup);
    Lesson lesson = begin(under, Mode::practice, Task::tighten);
    trainees::Operator hand(trainees::find_profile(trainee).value(), seed, setup);
    Played played;
    played.deviation = setup.wrench.deviation;
    while (lesson.due() != nullptr && state.tick < 1'200'000) {
        servo::Input input = hand.act(setup, state, lesson);
        input.setting = static_cast<float>(setting(lesson));
        const double trips = setting(lesson) * (1.0 + played.deviation);
        const servo::Output output = servo::tick(setup, state, input);
        if (output.clicked) {
            ++played.clicks;
            played.worst_click = std::max(played.worst_click, output.wrench_torque / trips - 1.0);
        }
        observe(lesson, state, output);
        lesson.events.clear();
    }
    played.finished = lesson.due() == nullptr;
    for (const JointResult& joint : judge(lesson, state, 1e-3).joints)
        played.in_window += joint.torque_verdict == Verdict::ok ? 1 : 0;
    return played;
}

}  // namespace

TEST_CASE(
    "Torque wrench: a torque wrench is set to the step's torque, and to nothing where none is asked for") {
    Script s;
    s.idle();
    CHECK(setting(s.lesson) == 0.0);  // run down
    s.seat(0);
    s.seat(1);
    CHECK(setting(s.lesson) == 0.0);  // a plain wrench has no scale
    s.assembly.wrench.click_swing = 0.07;
    CHECK(setting(s.lesson) == 35.0);
    s.pull(0, 35.0);
    s.pull(1, 35.0);
    CHECK(setting(s.lesson) == 70.0);
    s.pull(0, 70.0);
    s.pull(1, 70.0);
    CHECK(setting(s.lesson) == 0.0);  // all is done
}

TEST_CASE("Torque wrench: a click is told once, with its torque") {
    Script s;
    s.seat_both();
    s.tick(0, servo::Grip::wrench, 34.5, 0.0, true);
    for (int i = 0; i < 50; ++i) s.tick(0, servo::Grip::wrench, 17.0);
    CHECK(s.count("click") == 1);
    for (const Event& event : s.lesson.events)
        if (event.kind == "click") {
            CHECK(event.joint == 0);
            CHECK(event.value == 34.5);
        }
}

TEST_CASE(
    "Torque wrench: by strategy yield a step is done at the click too, that of this step and not one "
    "before") {
    Script s(Mode::guided, content::Strategy::yield);
    s.assembly.wrench.click_swing = 0.07;
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

TEST_CASE("Torque wrench: pulled on past the click it is too much, and said to be") {
    Script s;
    s.assembly.wrench.click_swing = 0.07;
    s.seat_both();
    for (const int joint : {0, 1}) s.pull(joint, 35.0);
    s.tick(0, servo::Grip::wrench, 70.0, 0.0, true);
    s.pull(0, 90.0);
    CHECK(s.count("mistake") == 1);
    CHECK(judge_joint(s.lesson, 0, s.state).torque_verdict == Verdict::high);
}

TEST_CASE("Torque wrench: trainees stop at the click, under both laws, and do better with it than without") {
    const content::Assembly plain = cover_with("wrench"), torque = cover_with("torque_wrench");
    for (const joint::Law law : {joint::Law::mechanistic, joint::Law::published}) {
        const Played expert = play_through(torque, "expert", 3, law);
        CHECK(expert.finished);
        CHECK(expert.in_window == 4);
        CHECK(expert.clicks >= 8);
        CHECK(expert.worst_click <= 1e-9);
    }
    int with = 0, without = 0;
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Played clicked = play_through(torque, "novice", seed);
        const Played felt = play_through(plain, "novice", seed);
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
