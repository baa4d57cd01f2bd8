// Undoing and restarting steps of a lesson.

#include <doctest/doctest.h>

#include "content/format/assembly.hpp"
#include "game/lesson/judge.hpp"
#include "game/session/lesson_session.hpp"
#include "game/trainees/trainee.hpp"
#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::lesson;
using test::Script;

namespace {

bool same(const JointTrack& a, const JointTrack& b) {
    return a.result.torque == b.result.torque && a.result.angle == b.result.angle &&
           a.result.strokes == b.result.strokes && a.mark == b.mark && a.peak_torque == b.peak_torque &&
           a.turned_torque == b.turned_torque && a.begin_angle == b.begin_angle && a.yielded == b.yielded &&
           a.over_torque_reported == b.over_torque_reported && a.done_in_pass == b.done_in_pass;
}

void work(Script& s) {
    const auto joint = static_cast<int>(s.lesson.due()->joint);
    if (s.lesson.current < 2)
        s.seat(joint);
    else
        s.pull(joint, s.lesson.current < 4 ? 35.0 : 95.0);
}

// The lesson's tracks and the state of the joints.
struct SavedState {
    std::vector<JointTrack> tracks;
    std::vector<joint::JointState> joints;
};

// Plays to the end. Returns the states at the start of every step and at the end.
std::vector<SavedState> play_through(Script& s) {
    std::vector<SavedState> states;
    while (s.lesson.due() != nullptr) {
        states.push_back({s.lesson.joints, s.state.joints});
        const std::size_t step = s.lesson.current;
        work(s);
        REQUIRE(s.lesson.current == step + 1);
    }
    states.push_back({s.lesson.joints, s.state.joints});
    return states;
}

}  // namespace

TEST_CASE("Undo: returning to a step restores the joint tracks of its start") {
    for (std::size_t steps = 1; steps <= 6; ++steps) {
        CAPTURE(steps);
        Script s;
        s.idle();
        const std::vector<SavedState> states = play_through(s);
        REQUIRE(states.size() == 7);
        const std::size_t to = 6 - steps;
        s.state.joints = states[to].joints;
        REQUIRE(s.undo(steps));
        CHECK(s.lesson.current == to);
        for (std::size_t i = 0; i < 2; ++i) CHECK(same(s.lesson.joints[i], states[to].tracks[i]));
        // The lesson continues from there as before.
        const std::vector<SavedState> again = play_through(s);
        REQUIRE(again.size() == steps + 1);
        for (std::size_t i = 0; i < 2; ++i) CHECK(same(again.back().tracks[i], states.back().tracks[i]));
    }
}

TEST_CASE("Undo: undoing a step clears its excess torque, but not the deduction") {
    Script s;
    s.seat_both();
    const auto before = s.state.joints;
    s.pull(0, 95.0);
    CHECK(s.judged(0).overall == Verdict::high);
    s.state.joints = before;
    REQUIRE(s.undo(1));
    CHECK(s.lesson.due()->joint == 0);
    s.pull(0, 35.0);
    s.pull(1, 35.0);
    s.pull(0, 70.0);
    s.pull(1, 70.0);
    REQUIRE(s.lesson.due() == nullptr);
    CHECK(s.judged(0).overall == Verdict::ok);
    const LessonResult result = judge(s.lesson, s.present(), 1e-3);
    REQUIRE(result.reasons.size() == 1);
    CHECK(result.reasons[0].kind == DeductionKind::over_torque);
    CHECK(result.score == 98.0);
}

TEST_CASE("Undo: mistakes stay counted, and an event reports the undo") {
    Script s;
    s.seat_both();
    s.pull(1, 20.0);  // out of turn
    s.pull(0, 35.0);
    s.pull(0, 36.0);  // done already
    s.lesson.events.clear();
    s.tick(1, servo::Grip::wrench, 5.0);
    REQUIRE(s.undo(3));
    CHECK(s.lesson.joints[1].result.out_of_turn == 1);
    CHECK(s.lesson.joints[0].result.done_already == 1);
    std::vector<EventKind> kinds;
    for (const LessonEvent& event : s.lesson.events) kinds.push_back(event.kind);
    // The undo returns to an earlier pass, which is announced again.
    CHECK(kinds == std::vector{EventKind::engage, EventKind::release, EventKind::undo, EventKind::pass_begin,
                               EventKind::step_begin});
    const LessonEvent& undo = s.lesson.events[2];
    CHECK(undo.joint == 0);
    CHECK(undo.value == 3.0);
    CHECK(undo.text == "back to step 1 of 6");
    CHECK(s.lesson.held_joint == -1);
    // The hand is still on the nut, which counts as a new hold.
    s.tick(1, servo::Grip::wrench, 5.0);
    CHECK(s.lesson.joints[1].result.out_of_turn == 2);
}

TEST_CASE("Undo: restarting a step keeps the step, announces no pass and clears its pulls") {
    Script s;
    s.seat_both();
    s.pull(0, 20.0);
    CHECK(s.lesson.joints[0].result.strokes == 1);
    const int passes = s.count(EventKind::pass_begin);
    REQUIRE(s.undo(0));
    CHECK(s.lesson.current == 2);
    CHECK(s.lesson.joints[0].peak_torque == 0.0);
    CHECK(s.lesson.joints[0].result.strokes == 0);
    CHECK(s.count(EventKind::pass_begin) == passes);
    s.pull(0, 20.0);
    CHECK(s.lesson.current == 2);
    s.pull(0, 32.0);
    CHECK(s.lesson.current == 3);
}

TEST_CASE("Undo: refused in assessment, before the first step and beyond the first step") {
    Script examined(Mode::assessment);
    examined.seat_both();
    const std::size_t undo = examined.lesson.events.size();
    CHECK_FALSE(examined.undo(1));
    CHECK(examined.lesson.current == 2);
    CHECK(examined.lesson.events.size() == undo);

    Script s;
    CHECK_FALSE(s.undo(0));  // it has not begun
    s.seat_both();
    CHECK_FALSE(s.undo(3));
    CHECK(s.lesson.current == 2);
    for (const double torque : {35.0, 70.0})
        for (const int joint : {0, 1}) s.pull(joint, torque);
    REQUIRE(s.lesson.due() == nullptr);
    CHECK_FALSE(s.undo(0));
    CHECK(s.undo(1));
    CHECK(s.lesson.current == 5);
}

TEST_CASE("Undo: after undoing any step, with joints restored or not, a simulated trainee finishes") {
    const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
    REQUIRE(loaded.ok());
    const content::Assembly& assembly = loaded.assembly;
    const servo::Setup setup = session::make_setup(assembly, joint::Law::mechanistic, {}, 5, 1e-3);
    for (const Task task : {Task::tighten, Task::loosen})
        for (const bool restored : {true, false}) {
            servo::State state = servo::initial_state(setup);
            if (task == Task::loosen) REQUIRE(session::pretighten(assembly, setup, state).has_value());
            world::World world = test::make_world(state);
            Lesson lesson = begin(assembly, Mode::guided, task);
            trainees::SimulatedTrainee hand(trainees::find_profile("expert").value(), 5, setup);
            std::vector<std::vector<joint::JointState>> before{state.joints};
            std::size_t furthest = 0;
            int backs = 0;
            // Two steps forward and one back, until the end.
            while (lesson.due() != nullptr && state.tick < 3'600'000) {
                const servo::Output output = servo::tick(setup, state, hand.act(setup, state, lesson));
                test::observe_tick(lesson, world, state, output);
                before.resize(std::min(before.size(), lesson.current + 1));
                if (before.size() == lesson.current) before.push_back(state.joints);
                if (lesson.current > furthest) {
                    furthest = lesson.current;
                    const std::size_t steps = furthest % 3 == 0 ? 2 : 1;
                    if (furthest < steps) continue;
                    if (restored) state.joints = before[furthest - steps];
                    world::write_initial_state(world, state);
                    REQUIRE(undo_steps(lesson, world, steps));
                    ++backs;
                }
            }
            CAPTURE(static_cast<int>(task));
            CAPTURE(restored);
            CHECK(lesson.due() == nullptr);
            CHECK(backs == static_cast<int>(lesson.steps.size()));
            for (const JointResult& joint : judge(lesson, world, 1e-3).joints) {
                CAPTURE(joint.id);
                if (restored) CHECK(joint.overall == Verdict::ok);
            }
        }
}
