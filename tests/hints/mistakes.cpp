#include "game/lesson/feedback.hpp"

#include <doctest/doctest.h>

#include "tests/hints/bench.hpp"

namespace hints_mistakes_test {

using namespace bolt;
using namespace bolt::lesson;
using test::Bench;

namespace {

words::Words words_in(std::string_view language) {
    words::LoadedWords loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

struct Watch {
    Bench b;
    MistakeState mistakes;
    explicit Watch(Mode mode = Mode::guided) : b(mode) {}

    void take() {
        for (const LessonEvent& event : b.lesson.events) add_event(mistakes, b.lesson, event);
        b.lesson.events.clear();
    }
    MistakeKind after(double seconds) {
        take();
        for (double t = 0.0; t < seconds - 1e-9; t += 0.05) update(mistakes, 0.05);
        return mistakes.shown ? mistakes.shown->kind : MistakeKind::none;
    }
};

}  // namespace

TEST_CASE("Mistakes: each mistake has its complete text and remedy in every language") {
    struct Case {
        MistakeKind kind;
        const char* text;
        void (*make)(Bench&);
    };
    const Case cases[] = {
        {MistakeKind::out_of_turn, "B is not due yet.", [](Bench& b) { b.pull(1, 10.0); }},
        {MistakeKind::done_already, "A has had its turn in this round.",
         [](Bench& b) {
             b.pull(0, 35.0);
             b.pull(0, 10.0);
         }},
        {MistakeKind::loosened, "A was turned the wrong way: that loosens it.",
         [](Bench& b) { b.turn(0, -20.0, -2.0); }},
        {MistakeKind::tightened, "A was turned the wrong way: that tightens it.",
         [](Bench& b) {
             b.lesson = begin(b.assembly, b.lesson.mode, Task::loosen);
             b.turn(0, 20.0, 2.0);
         }},
        {MistakeKind::over_torque, "A was turned with more than 77 N·m.", [](Bench& b) { b.turn(0, 80.0); }},
        {MistakeKind::slipped, "The wrench slipped off A; the nut's corners have lost 0.25 mm.",
         [](Bench& b) {
             b.turn(0, 30.0);
             servo::Output output;
             output.slipped = 0;
             output.rounded = 0.25e-3;
             b.state.rounded[0] = output.rounded;
             ++b.state.tick;
             test::observe_tick(b.lesson, b.components, b.state, output);
         }},
        {MistakeKind::stripped, "The thread of A is stripped.",
         [](Bench& b) {
             b.turn(0, 30.0);
             b.state.joints[0].condition = joint::JointCondition::stripped;
             b.tick(0, servo::Grip::wrench, 1.0);
         }},
        {MistakeKind::broken, "The bolt of A is broken.",
         [](Bench& b) {
             b.turn(0, 30.0);
             b.state.joints[0].condition = joint::JointCondition::broken;
             b.tick(0, servo::Grip::wrench, 1.0);
         }},
    };
    for (const Case& c : cases) {
        CAPTURE(c.text);
        Watch w;
        w.b.seat_both();
        c.make(w.b);
        CHECK(w.after(0.5) == c.kind);
        REQUIRE(w.mistakes.shown);
        CHECK(mistake_text(words_in("en"), *w.mistakes.shown) == c.text);
        for (const char* language : {"en", "de", "zh"}) {
            const words::Words words = words_in(language);
            for (const std::string& text :
                 {mistake_text(words, *w.mistakes.shown), remedy_text(words, *w.mistakes.shown)}) {
                CHECK(text.size() > 10);
                CHECK(text.find('{') == std::string::npos);
            }
        }
        CHECK(w.after(mistake_duration - 1.0) == c.kind);
        CHECK(w.after(1.0) == MistakeKind::none);

        // The same mistake with screws names no nut.
        Watch screws;
        for (content::AssemblyJoint& joint : screws.b.assembly.joints)
            joint.design.turned = joint::TurnedPart::head;
        screws.b.seat_both();
        c.make(screws.b);
        for (const LessonEvent& event : screws.b.lesson.events)
            CHECK(event.text.find("nut") == std::string::npos);
        screws.after(0.5);
        REQUIRE(screws.mistakes.shown);
        for (const char* language : {"en", "de", "zh"}) {
            const words::Words words = words_in(language);
            const std::string text =
                mistake_text(words, *screws.mistakes.shown) + remedy_text(words, *screws.mistakes.shown);
            CAPTURE(text);
            for (const char* word : {" nut", "Mutter", "螺母"}) CHECK(text.find(word) == std::string::npos);
        }

        Watch examined(Mode::assessment);
        examined.b.seat_both();
        c.make(examined.b);
        CHECK(examined.after(0.1) == MistakeKind::none);
    }
}

TEST_CASE("Mistakes: a graver mistake replaces a lesser one after its minimum duration, never the reverse") {
    Watch w;
    w.b.seat_both();
    w.b.turn(0, 80.0);
    CHECK(w.after(0.2) == MistakeKind::over_torque);
    w.b.state.joints[0].condition = joint::JointCondition::broken;
    w.b.tick(0, servo::Grip::wrench, 1.0);
    CHECK(w.after(0.2) == MistakeKind::over_torque);
    CHECK(w.after(min_mistake_duration) == MistakeKind::broken);
    w.b.idle();
    w.b.pull(0, 5.0);  // done already
    CHECK(w.after(mistake_duration - 0.5) == MistakeKind::broken);
    CHECK(w.after(1.0) == MistakeKind::none);
}

TEST_CASE("Mistakes: undoing a step hides its mistake") {
    Watch w;
    w.b.seat_both();
    w.b.turn(0, 80.0);
    CHECK(w.after(0.5) == MistakeKind::over_torque);
    REQUIRE(w.b.undo(0));
    CHECK(w.after(0.05) == MistakeKind::none);
}

}  // namespace hints_mistakes_test
