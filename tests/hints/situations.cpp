// Every state of a lesson, and what is said in it, in every mode.

#include <doctest/doctest.h>

#include <set>

#include "game/lesson/hints.hpp"
#include "tests/hints/bench.hpp"

using namespace bolt;
using namespace bolt::lesson;
using namespace bolt::lesson;
using test::Bench;

namespace {

using servo::Grip;
constexpr auto torque = content::Strategy::torque;
constexpr auto yield = content::Strategy::yield;

struct Case {
    Situation situation;
    const char* text;
    Motion motion;
    void (*arrange)(Bench&);
    content::Strategy strategy = torque;
    Task task = Task::tighten;
};

const Case cases[] = {
    {Situation::take_wrench, "hint.take_wrench", Motion::take, [](Bench& b) { b.seat_both(); }},
    {Situation::put_wrench_away, "hint.put_wrench_away", Motion::put_away,
     [](Bench& b) {
         b.idle();
         b.wrench = true;
     }},
    {Situation::put_wrench_away, "hint.put_wrench_away", Motion::put_away,
     [](Bench& b) { b.tick(0, Grip::wrench, 0.2, 0.5); }},
    {Situation::find_by_wrench, "hint.find_by_wrench", Motion::approach,
     [](Bench& b) {
         b.seat_both();
         b.wrench = true;
     }},
    {Situation::find_by_fingers, "hint.find_by_fingers", Motion::reach, [](Bench& b) { b.idle(); }},
    {Situation::set_on, "hint.set_on", Motion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.wrench = true;
         b.near(0);
     }},
    {Situation::set_on_again, "hint.set_on_again", Motion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.pull(0, 20.0);
         b.wrench = true;
         b.near(0);
     }},
    {Situation::set_on_rounded, "hint.set_on_rounded", Motion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.rounded[0] = 0.4e-3;
         b.wrench = true;
         b.near(0);
     }},
    {Situation::grip_nut, "hint.grip_nut", Motion::grip_nut,
     [](Bench& b) {
         b.idle();
         b.near(0);
     }},
    {Situation::run_down, "hint.run_down", Motion::spin,
     [](Bench& b) { b.tick(0, Grip::fingers, 0.1, 1.0); }},
    {Situation::run_down_by_wrench, "hint.run_down_by_wrench", Motion::pull_on,
     [](Bench& b) {
         b.assembly.joints[0].design.prevailing_torque = 6.0;
         b.tick(0, Grip::wrench, 6.0, 1.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", Motion::let_go,
     [](Bench& b) {
         b.assembly.joints[0].design.prevailing_torque = 6.0;
         b.tick(0, Grip::fingers, 0.7, 0.0);
     }},
    {Situation::twist_back, "hint.twist_back", Motion::twist_back,
     [](Bench& b) {
         b.tick(0, Grip::fingers, 0.1, 1.0);
         b.room = 0.01;
     }},
    {Situation::other_way_on, "hint.other_way_on", Motion::spin,
     [](Bench& b) { b.tick(0, Grip::fingers, -0.1, -1.0); }},
    {Situation::seated, "hint.seated", Motion::let_go,
     [](Bench& b) {
         b.tick(0, Grip::fingers, 0.1, 1.0);
         b.state.joints[0].stage = joint::Stage::transition;
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::pull, "hint.pull", Motion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 10.0);
     }},
    {Situation::pull_to_yield, "hint.pull_to_yield", Motion::pull_on,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 40.0);
     },
     yield},
    {Situation::pull_to_click, "hint.pull_to_click", Motion::pull_on,
     [](Bench& b) {
         b.assembly.wrench.click_swing = 0.07;
         b.seat_both();
         b.turn(0, 30.0);
     }},
    {Situation::stop_at_click, "hint.stop_at_click", Motion::lift,
     [](Bench& b) {
         b.assembly.wrench.click_swing = 0.07;
         b.seat_both();
         b.turn(0, 35.0);
         b.tick(0, Grip::wrench, 34.0, 0.0, true);
         b.tick(0, Grip::wrench, 17.0);
     }},
    {Situation::set_back, "hint.set_back", Motion::set_back,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 10.0);
         b.room = 0.02;
     }},
    {Situation::ease, "hint.ease", Motion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 27.0);
     }},
    {Situation::ease_to_yield, "hint.ease_to_yield", Motion::pull_on,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 66.0);
     },
     yield},
    {Situation::stop, "hint.stop", Motion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 33.0);
     }},
    {Situation::stop_at_yield, "hint.stop_at_yield", Motion::lift,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 66.0);
         b.state.joints[0].stage = joint::Stage::yield;
         b.tick(0, Grip::wrench, 67.0, 1.0);
     },
     yield},
    {Situation::stop_too_much, "hint.stop_too_much", Motion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
     }},
    {Situation::take_off, "hint.take_off", Motion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 33.0);
         b.tick(0, Grip::wrench, 3.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", Motion::let_go,
     [](Bench& b) {
         b.seat_both();
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::other_way_on, "hint.other_way_on", Motion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, -4.0, -1.0);
     }},
    {Situation::other_way_on, "hint.other_way_on", Motion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.tick(0, Grip::wrench, -20.0);  // it holds
     }},
    {Situation::wrong_joint, "hint.wrong_joint", Motion::lift,
     [](Bench& b) {
         b.seat_both();
         b.tick(1, Grip::wrench, 0.2);
     }},
    {Situation::wrong_joint, "hint.wrong_joint", Motion::let_go,
     [](Bench& b) { b.tick(1, Grip::fingers, 0.0); }},
    {Situation::leave_broken, "hint.leave_broken", Motion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
         b.state.joints[0].condition = joint::Condition::broken;
         b.tick(0, Grip::wrench, 0.0);
     }},
    {Situation::leave_stripped, "hint.leave_stripped", Motion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
         b.state.joints[0].condition = joint::Condition::stripped;
         b.tick(0, Grip::wrench, 0.0);
     }},
    {Situation::check, "hint.check", Motion::pull_on,
     [](Bench& b) {
         b.to_the_check();
         b.tick(0, Grip::wrench, 30.0);
     }},
    {Situation::checked, "hint.checked", Motion::lift,
     [](Bench& b) {
         b.to_the_check();
         b.turn(0, 60.0, 0.1);  // it moves, below its window
     }},
    {Situation::checked, "hint.checked", Motion::lift,
     [](Bench& b) {
         b.to_the_check();
         b.tick(0, Grip::wrench, 64.0);  // it does not, within it
     }},
    {Situation::take_wrench, "hint.take_wrench", Motion::take, [](Bench& b) { b.idle(); }, torque,
     Task::loosen},
    {Situation::break_loose, "hint.break_loose", Motion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, -40.0); }, torque, Task::loosen},
    {Situation::turn_off, "hint.turn_off", Motion::pull_off, [](Bench& b) { b.turn(1, -20.0, -1.0); }, torque,
     Task::loosen},
    {Situation::other_way_off, "hint.other_way_off", Motion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, 20.0); }, torque, Task::loosen},
    {Situation::other_way_off, "hint.other_way_off", Motion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, 3.0, 0.5); }, torque, Task::loosen},
    {Situation::wrench_needed, "hint.wrench_needed", Motion::let_go,
     [](Bench& b) { b.tick(1, Grip::fingers, -0.5); }, torque, Task::loosen},
    {Situation::set_back, "hint.set_back", Motion::set_back,
     [](Bench& b) {
         b.tick(1, Grip::wrench, -40.0);
         b.room = 0.0;
     },
     torque, Task::loosen},
    {Situation::free, "hint.free", Motion::lift,
     [](Bench& b) {
         b.turn(1, -20.0, -1.0);
         b.state.joints[1].stage = joint::Stage::navigation;
         b.tick(1, Grip::wrench, -0.1, -1.0);
     },
     torque, Task::loosen},
    {Situation::all_done, "hint.all_done", Motion::none,
     [](Bench& b) {
         b.to_the_check();
         for (const int joint : {0, 1}) b.pull(joint, 70.0);
     }},
};

// Said when a step begins; they come with time.
constexpr Situation announced[] = {Situation::next, Situation::round_run_down, Situation::round_tighten,
                                   Situation::round_recheck, Situation::round_loosen};

words::Words words_in(std::string_view language) {
    words::Loaded loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

}  // namespace

TEST_CASE("Hints: every state of a lesson is known for what it is") {
    std::set<Situation> seen(std::begin(announced), std::end(announced));
    for (const Case& c : cases) {
        CAPTURE(c.text);
        for (const Mode mode : {Mode::guided, Mode::practice, Mode::assessment}) {
            Bench b(mode, c.strategy, c.task);
            c.arrange(b);
            CHECK(static_cast<int>(b.now()) == static_cast<int>(c.situation));
        }
        seen.insert(c.situation);
    }
    CHECK(seen.size() == situation_count);
}

TEST_CASE(
    "Hints: a guided lesson has a hint in every state, of the due joint, in every language and in full") {
    std::vector<words::Words> languages;
    for (const char* language : {"en", "de", "zh"}) languages.push_back(words_in(language));
    for (const Case& c : cases) {
        CAPTURE(c.text);
        Bench b(Mode::guided, c.strategy, c.task);
        c.arrange(b);
        b.wait(3.5);  // an announcement is over by then
        REQUIRE(b.hints.shown);
        const Hint hint = *b.hints.shown;
        CHECK(static_cast<int>(hint.situation) == static_cast<int>(c.situation));
        CHECK(hint.text.row().name == c.text);
        CHECK(static_cast<int>(hint.motion) == static_cast<int>(c.motion));
        const Step* due = b.lesson.due();
        CHECK(hint.joint == (due == nullptr ? -1 : static_cast<int>(due->joint)));
        for (int level = 0; level <= 3; ++level) {
            Hint at = hint;
            at.level = level;
            for (const words::Words& language : languages) {
                const std::string said = say(language, at);
                CHECK_FALSE(said.empty());
                CHECK(said.find('{') == std::string::npos);
                for (const Controls& controls :
                     {mouse_controls(language, "T"), device_controls(language, "A", "T"),
                      puck_controls(language, "A", "T"), keyboard_controls(language, "Space", "T"),
                      glove_controls(language, puck_controls(language, "A", "T"))}) {
                    const std::string motion = say_motion(language, at, controls);
                    CHECK(motion.empty() == (level < 3 || c.motion == Motion::none));
                    CHECK(motion.find('{') == std::string::npos);
                    const std::string& pressed = controls[static_cast<std::size_t>(c.motion)];
                    CHECK(pressed.empty() == (c.motion == Motion::none));
                    CHECK((motion.empty() || motion.find(pressed) != std::string::npos));
                }
            }
        }
    }
}

TEST_CASE("Hints: assessment: no hint in any state, at any time, asked for or not") {
    for (const Case& c : cases) {
        Bench b(Mode::assessment, c.strategy, c.task);
        c.arrange(b);
        for (int i = 0; i < 1000; ++i) CHECK_FALSE(b.frame(0.1, i % 7 == 0).has_value());
    }
}

TEST_CASE("Hints: practice: nothing in any state until long has passed, or somebody asks") {
    for (const Case& c : cases) {
        CAPTURE(c.text);
        Bench b(Mode::practice, c.strategy, c.task);
        c.arrange(b);
        CHECK_FALSE(b.wait(19.0).has_value());
        CHECK(b.wait(2.0).has_value());
        Bench asked(Mode::practice, c.strategy, c.task);
        c.arrange(asked);
        asked.wait(3.5);
        CHECK_FALSE(asked.frame().has_value());
        REQUIRE(asked.frame(0.05, true).has_value());
        CHECK(static_cast<int>(asked.hints.shown->situation) == static_cast<int>(c.situation));
    }
}

TEST_CASE("Hints: what is said has the numbers of the step") {
    const words::Words en = words_in("en");
    Bench b;
    b.seat_both();
    b.turn(0, 10.0);
    b.wait(2.0);
    CHECK(say(en, *b.hints.shown) == "Pull clockwise, smoothly, until A has 35 N·m.");
    b.turn(0, 45.0);
    b.frame();
    CHECK(say(en, *b.hints.shown) == "Stop. A was to get 38.5 N·m at most.");
    Bench wrong;
    wrong.seat_both();
    wrong.tick(1, Grip::wrench, 0.2);
    wrong.wait(2.0);
    CHECK(say(en, *wrong.hints.shown) == "This is B. A is due: let go and go there.");
    Bench start;
    start.seat_both();
    start.frame();
    CHECK(say(en, *start.hints.shown) == "This round: all nuts to 50 % of their torque. Begin with A.");
    start.wait(4.0);
    CHECK(say(en, *start.hints.shown) == "Take the 24 mm wrench.");
    start.wait(12.0);
    CHECK(say_motion(en, *start.hints.shown, mouse_controls(en, "T")) ==
          "Move the hand to the wrench and close it on the handle: press T or click on the wrench.");
}

TEST_CASE("Hints: who wears a glove is told how what they hold is moved, and closes the hand itself") {
    const auto loaded = words::load_words(words::words_folder(), "en");
    REQUIRE(loaded.ok());
    const Controls keys = keyboard_controls(loaded.words, "Space", "T"),
                   gloved = glove_controls(loaded.words, keys);
    const auto of = [](const Controls& controls, Motion motion) {
        return controls[static_cast<std::size_t>(motion)];
    };
    CHECK(of(gloved, Motion::set_on) == of(keys, Motion::set_on));
    CHECK(of(gloved, Motion::pull_on) == of(keys, Motion::pull_on));
    CHECK(of(gloved, Motion::take).find("close your hand") != std::string::npos);
    CHECK(of(gloved, Motion::grip_nut).find("pinch") != std::string::npos);
}
