#include "game/lesson/feedback.hpp"

#include <doctest/doctest.h>

#include "tests/hints/bench.hpp"

using namespace bolt;
using namespace bolt::lesson;
using namespace bolt::lesson;
using test::Bench;

namespace {

words::Words words_in(std::string_view language) {
    words::Loaded loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

struct Watch {
    Bench b;
    Mistakes mistakes;
    explicit Watch(Mode mode = Mode::guided) : b(mode) {}

    void take() {
        for (const Event& event : b.lesson.events) note(mistakes, b.lesson, event);
        b.lesson.events.clear();
    }
    Cause after(double seconds) {
        take();
        for (double t = 0.0; t < seconds - 1e-9; t += 0.05) update(mistakes, 0.05);
        return mistakes.shown ? mistakes.shown->cause : Cause::none;
    }
};

}  // namespace

TEST_CASE("Mistakes: each mistake is shown with its why and what to do, in every language and in full") {
    struct Case {
        Cause cause;
        const char* why;
        void (*make)(Bench&);
    };
    const Case cases[] = {
        {Cause::out_of_turn, "B is not due yet.", [](Bench& b) { b.pull(1, 10.0); }},
        {Cause::done_already, "A has had its turn in this round.",
         [](Bench& b) {
             b.pull(0, 35.0);
             b.pull(0, 10.0);
         }},
        {Cause::loosened, "A was turned the wrong way: that loosens it.",
         [](Bench& b) { b.turn(0, -20.0, -2.0); }},
        {Cause::tightened, "A was turned the wrong way: that tightens it.",
         [](Bench& b) {
             b.lesson = begin(b.assembly, b.lesson.mode, Task::loosen);
             b.turn(0, 20.0, 2.0);
         }},
        {Cause::over_torque, "A was turned with more than 77 N·m.", [](Bench& b) { b.turn(0, 80.0); }},
        {Cause::slipped, "The wrench slipped off A; its corners have lost 0.25 mm.",
         [](Bench& b) {
             b.turn(0, 30.0);
             servo::Output output;
             output.slipped = 0;
             output.rounded = 0.25e-3;
             ++b.state.tick;
             observe(b.lesson, b.state, output);
         }},
        {Cause::stripped, "The thread of A is stripped.",
         [](Bench& b) {
             b.turn(0, 30.0);
             b.state.joints[0].condition = joint::Condition::stripped;
             b.tick(0, servo::Grip::wrench, 1.0);
         }},
        {Cause::broken, "The bolt of A is broken.",
         [](Bench& b) {
             b.turn(0, 30.0);
             b.state.joints[0].condition = joint::Condition::broken;
             b.tick(0, servo::Grip::wrench, 1.0);
         }},
    };
    for (const Case& c : cases) {
        CAPTURE(c.why);
        Watch w;
        w.b.seat_both();
        c.make(w.b);
        CHECK(w.after(0.5) == c.cause);
        REQUIRE(w.mistakes.shown);
        CHECK(say_why(words_in("en"), *w.mistakes.shown) == c.why);
        for (const char* language : {"en", "de", "zh"}) {
            const words::Words words = words_in(language);
            for (const std::string& said :
                 {say_why(words, *w.mistakes.shown), say_what_to_do(words, *w.mistakes.shown)}) {
                CHECK(said.size() > 10);
                CHECK(said.find('{') == std::string::npos);
            }
        }
        CHECK(w.after(mistake_stands - 1.0) == c.cause);
        CHECK(w.after(1.0) == Cause::none);

        Watch examined(Mode::assessment);
        examined.b.seat_both();
        c.make(examined.b);
        CHECK(examined.after(0.1) == Cause::none);
    }
}

TEST_CASE(
    "Mistakes: a graver mistake takes the place of a lesser one when that could be read, and never the other "
    "way") {
    Watch w;
    w.b.seat_both();
    w.b.turn(0, 80.0);
    CHECK(w.after(0.2) == Cause::over_torque);
    w.b.state.joints[0].condition = joint::Condition::broken;
    w.b.tick(0, servo::Grip::wrench, 1.0);
    CHECK(w.after(0.2) == Cause::over_torque);
    CHECK(w.after(shortest_mistake) == Cause::broken);
    w.b.idle();
    w.b.pull(0, 5.0);  // its step is over: done already
    CHECK(w.after(mistake_stands - 0.5) == Cause::broken);
    CHECK(w.after(1.0) == Cause::none);
}

TEST_CASE("Mistakes: a step that is taken back takes its mistake along") {
    Watch w;
    w.b.seat_both();
    w.b.turn(0, 80.0);
    CHECK(w.after(0.5) == Cause::over_torque);
    REQUIRE(back(w.b.lesson, w.b.state, 0));
    CHECK(w.after(0.05) == Cause::none);
}
