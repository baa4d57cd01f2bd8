// Undo of steps by key and by mistakes.
#include "game/trainer/step_undo.hpp"

#include <doctest/doctest.h>

#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::trainer;
using lesson::Mode;
using test::Script;

namespace {

void observe_events(StepUndo& undo, Script& s) {
    for (const lesson::LessonEvent& event : s.lesson.events) observe(undo, s.lesson, event);
    s.lesson.events.clear();
}

}  // namespace

TEST_CASE("Step undo: a key's request expires if it cannot be granted") {
    Script s(Mode::practice);
    s.seat_both();
    StepUndo undo;
    CHECK_FALSE(steps_to_undo(undo, s.lesson));
    request_undo(undo, s.lesson, 1);
    CHECK(steps_to_undo(undo, s.lesson) == 1);
    update(undo, 5.0);
    CHECK(steps_to_undo(undo, s.lesson) == 1);
    update(undo, 2.0);
    CHECK_FALSE(steps_to_undo(undo, s.lesson));
    request_undo(undo, s.lesson, 3);  // more steps than there are
    CHECK_FALSE(steps_to_undo(undo, s.lesson));
}

TEST_CASE("Step undo: a step restarts even if releasing the nut completes it first") {
    Script s(Mode::practice);
    s.seat_both();
    s.tick(0, servo::Grip::wrench, 40.0, 1.0);
    StepUndo undo;
    request_undo(undo, s.lesson, 0);
    const std::size_t step = s.lesson.current;
    s.idle();
    REQUIRE(s.lesson.current == step + 1);
    CHECK(steps_to_undo(undo, s.lesson) == 1);
}

TEST_CASE("Step undo: a mistake restarts its step in a guided lesson only, and waits for the hand") {
    for (const Mode mode : {Mode::guided, Mode::practice, Mode::assessment}) {
        Script s(mode);
        s.seat_both();
        const std::size_t step = s.lesson.current;
        StepUndo undo;
        observe_events(undo, s);
        CHECK_FALSE(steps_to_undo(undo, s.lesson));
        s.pull(1, 20.0);  // out of turn
        observe_events(undo, s);
        update(undo, 100.0);
        const bool returns = mode == Mode::guided;
        CHECK(steps_to_undo(undo, s.lesson).has_value() == returns);
        if (!returns) continue;
        CHECK(undo.by_mistake);
        request_undo(undo, s.lesson, 0);  // a key requests the same
        CHECK(undo.by_mistake);
        CHECK(steps_to_undo(undo, s.lesson) == 0);
        s.pull(0, 35.0);  // work done meanwhile is undone as well
        REQUIRE(s.lesson.current == step + 1);
        CHECK(steps_to_undo(undo, s.lesson) == 1);
        CHECK(due(undo, s.lesson) == &s.lesson.steps[step]);
        REQUIRE(s.undo(1));
        observe_events(undo, s);
        CHECK_FALSE(steps_to_undo(undo, s.lesson));
        CHECK(s.lesson.current == step);
        CHECK(due(undo, s.lesson) == s.lesson.due());
        s.pull(1, 20.0);
        observe_events(undo, s);
        s.pull(0, 35.0);
        request_undo(undo, s.lesson, 1);  // a key requests the previous step
        CHECK(steps_to_undo(undo, s.lesson) == 2);
    }
}

TEST_CASE("Step undo: an assessment undoes nothing") {
    Script s(Mode::assessment);
    s.seat_both();
    StepUndo undo;
    request_undo(undo, s.lesson, 0);
    CHECK_FALSE(steps_to_undo(undo, s.lesson));
}
