// Steps that are taken back, by whoever asks and by mistakes.

#include "game/trainer/step_undo.hpp"

#include <doctest/doctest.h>

#include "tests/lesson/script.hpp"

using namespace bolt;
using namespace bolt::trainer;
using lesson::Mode;
using test::Script;

namespace {

void take(StepUndo& back, Script& s) {
    for (const lesson::Event& event : s.lesson.events) note(back, s.lesson, event);
    s.lesson.events.clear();
}

}  // namespace

TEST_CASE("what a key has wished is forgotten when it cannot be granted for long") {
    Script s(Mode::practice);
    s.seat_both();
    StepUndo back;
    CHECK_FALSE(steps_back(back, s.lesson));
    go_back(back, s.lesson, 1);
    CHECK(steps_back(back, s.lesson) == 1);
    wait(back, 5.0);
    CHECK(steps_back(back, s.lesson) == 1);
    wait(back, 2.0);
    CHECK_FALSE(steps_back(back, s.lesson));
    go_back(back, s.lesson, 3);  // more than there are
    CHECK_FALSE(steps_back(back, s.lesson));
}

TEST_CASE("a step that is to begin anew does so though letting go of the nut ends it") {
    Script s(Mode::practice);
    s.seat_both();
    s.tick(0, servo::Grip::wrench, 40.0, 1.0);
    StepUndo back;
    go_back(back, s.lesson, 0);
    const std::size_t step = s.lesson.current;
    s.idle();
    REQUIRE(s.lesson.current == step + 1);
    CHECK(steps_back(back, s.lesson) == 1);
}

TEST_CASE("a mistake returns to the beginning of its step, in a guided lesson only, and waits for the hand") {
    for (const Mode mode : {Mode::guided, Mode::practice, Mode::assessment}) {
        Script s(mode);
        s.seat_both();
        const std::size_t step = s.lesson.current;
        StepUndo back;
        take(back, s);
        CHECK_FALSE(steps_back(back, s.lesson));
        s.pull(1, 20.0);  // out of turn
        take(back, s);
        wait(back, 100.0);
        const bool returns = mode == Mode::guided;
        CHECK(steps_back(back, s.lesson).has_value() == returns);
        if (!returns) continue;
        CHECK(back.by_mistake);
        go_back(back, s.lesson, 0);  // a key that asks for the same
        CHECK(back.by_mistake);
        CHECK(steps_back(back, s.lesson) == 0);
        s.pull(0, 35.0);  // what it goes on to do meanwhile is taken back, too
        REQUIRE(s.lesson.current == step + 1);
        CHECK(steps_back(back, s.lesson) == 1);
        CHECK(due(back, s.lesson) == &s.lesson.steps[step]);
        REQUIRE(lesson::back(s.lesson, s.state, 1));
        take(back, s);
        CHECK_FALSE(steps_back(back, s.lesson));
        CHECK(s.lesson.current == step);
        CHECK(due(back, s.lesson) == s.lesson.due());
        s.pull(1, 20.0);
        take(back, s);
        s.pull(0, 35.0);
        go_back(back, s.lesson, 1);  // a key that asks for the step before
        CHECK(steps_back(back, s.lesson) == 2);
    }
}

TEST_CASE("an assessment takes nothing back") {
    Script s(Mode::assessment);
    s.seat_both();
    StepUndo back;
    go_back(back, s.lesson, 0);
    CHECK_FALSE(steps_back(back, s.lesson));
}
