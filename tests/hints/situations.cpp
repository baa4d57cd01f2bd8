// Every situation of a lesson and its hint, in every mode.

#include <doctest/doctest.h>

#include <set>

#include "game/lesson/hints.hpp"
#include "tests/hints/bench.hpp"

namespace hints_situations_test {

using namespace bolt;
using namespace bolt::lesson;
using test::Bench;

namespace {

using servo::Grip;
constexpr auto torque = content::Strategy::torque;
constexpr auto yield = content::Strategy::yield;

struct Case {
    Situation situation;
    const char* text;
    HintMotion motion;
    void (*arrange)(Bench&);
    content::Strategy strategy = torque;
    Task task = Task::tighten;
};

const Case cases[] = {
    {Situation::take_wrench, "hint.take_wrench", HintMotion::take, [](Bench& b) { b.seat_both(); }},
    {Situation::put_wrench_away, "hint.put_wrench_away", HintMotion::put_away,
     [](Bench& b) {
         b.idle();
         b.wrench = true;
     }},
    {Situation::put_wrench_away, "hint.put_wrench_away", HintMotion::put_away,
     [](Bench& b) { b.tick(0, Grip::wrench, 0.2, 0.5); }},
    {Situation::find_by_wrench, "hint.find_by_wrench", HintMotion::approach,
     [](Bench& b) {
         b.seat_both();
         b.wrench = true;
     }},
    {Situation::find_by_fingers, "hint.find_by_fingers", HintMotion::reach, [](Bench& b) { b.idle(); }},
    {Situation::set_on, "hint.set_on", HintMotion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.wrench = true;
         b.near(0);
     }},
    {Situation::set_on_again, "hint.set_on_again", HintMotion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.pull(0, 20.0);
         b.wrench = true;
         b.near(0);
     }},
    {Situation::set_on_rounded, "hint.set_on_rounded", HintMotion::set_on,
     [](Bench& b) {
         b.seat_both();
         b.state.rounded[0] = 0.4e-3;
         b.wrench = true;
         b.near(0);
     }},
    {Situation::grip_nut, "hint.grip_nut", HintMotion::grip_nut,
     [](Bench& b) {
         b.idle();
         b.near(0);
     }},
    {Situation::run_down, "hint.run_down", HintMotion::spin,
     [](Bench& b) { b.tick(0, Grip::fingers, 0.1, 1.0); }},
    {Situation::run_down_by_wrench, "hint.run_down_by_wrench", HintMotion::pull_on,
     [](Bench& b) {
         b.assembly.joints[0].design.prevailing_torque = 6.0;
         b.tick(0, Grip::wrench, 6.0, 1.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) {
         b.assembly.joints[0].design.prevailing_torque = 6.0;
         b.tick(0, Grip::fingers, 0.7, 0.0);
     }},
    {Situation::twist_back, "hint.twist_back", HintMotion::twist_back,
     [](Bench& b) {
         b.tick(0, Grip::fingers, 0.1, 1.0);
         b.free_swing = 0.01;
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::spin,
     [](Bench& b) { b.tick(0, Grip::fingers, -0.1, -1.0); }},
    {Situation::seated, "hint.seated", HintMotion::let_go,
     [](Bench& b) {
         b.tick(0, Grip::fingers, 0.1, 1.0);
         b.state.joints[0].stage = joint::Stage::transition;
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::pull, "hint.pull", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 10.0);
     }},
    {Situation::pull_to_yield, "hint.pull_to_yield", HintMotion::pull_on,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 40.0);
     },
     yield},
    {Situation::pull_to_click, "hint.pull_to_click", HintMotion::pull_on,
     [](Bench& b) {
         b.assembly.wrench.click_swing = 0.07;
         b.seat_both();
         b.turn(0, 30.0);
     }},
    {Situation::stop_at_click, "hint.stop_at_click", HintMotion::lift,
     [](Bench& b) {
         b.assembly.wrench.click_swing = 0.07;
         b.seat_both();
         b.turn(0, 35.0);
         b.tick(0, Grip::wrench, 34.0, 0.0, true);
         b.tick(0, Grip::wrench, 17.0);
     }},
    {Situation::set_back, "hint.set_back", HintMotion::set_back,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 10.0);
         b.free_swing = 0.02;
     }},
    {Situation::ease, "hint.ease", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 27.0);
     }},
    {Situation::ease_to_yield, "hint.ease_to_yield", HintMotion::pull_on,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 66.0);
     },
     yield},
    {Situation::stop, "hint.stop", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 33.0);
     }},
    {Situation::stop_at_yield, "hint.stop_at_yield", HintMotion::lift,
     [](Bench& b) {
         b.to_the_full_pass();
         b.turn(0, 66.0);
         b.state.joints[0].stage = joint::Stage::yield;
         b.tick(0, Grip::wrench, 67.0, 1.0);
     },
     yield},
    {Situation::stop_too_much, "hint.stop_too_much", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
     }},
    {Situation::take_off, "hint.take_off", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 33.0);
         b.tick(0, Grip::wrench, 3.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) {
         b.seat_both();
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, -4.0, -1.0);
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::pull_on,
     [](Bench& b) {
         b.seat_both();
         b.tick(0, Grip::wrench, -20.0);  // the nut does not move
     }},
    {Situation::wrong_joint, "hint.wrong_joint", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.tick(1, Grip::wrench, 0.2);
     }},
    {Situation::wrong_joint, "hint.wrong_joint", HintMotion::let_go,
     [](Bench& b) { b.tick(1, Grip::fingers, 0.0); }},
    {Situation::leave_broken, "hint.leave_broken", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
         b.state.joints[0].condition = joint::JointCondition::broken;
         b.tick(0, Grip::wrench, 0.0);
     }},
    {Situation::leave_stripped, "hint.leave_stripped", HintMotion::lift,
     [](Bench& b) {
         b.seat_both();
         b.turn(0, 45.0);
         b.state.joints[0].condition = joint::JointCondition::stripped;
         b.tick(0, Grip::wrench, 0.0);
     }},
    {Situation::check, "hint.check", HintMotion::pull_on,
     [](Bench& b) {
         b.to_the_check();
         b.tick(0, Grip::wrench, 30.0);
     }},
    {Situation::checked, "hint.checked", HintMotion::lift,
     [](Bench& b) {
         b.to_the_check();
         b.turn(0, 60.0, 0.1);  // the nut moves below the window
     }},
    {Situation::checked, "hint.checked", HintMotion::lift,
     [](Bench& b) {
         b.to_the_check();
         b.tick(0, Grip::wrench, 64.0);  // it does not move within the window
     }},
    {Situation::take_wrench, "hint.take_wrench", HintMotion::take, [](Bench& b) { b.idle(); }, torque,
     Task::loosen},
    {Situation::break_loose, "hint.break_loose", HintMotion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, -40.0); }, torque, Task::loosen},
    {Situation::unscrew, "hint.turn_off", HintMotion::pull_off, [](Bench& b) { b.turn(1, -20.0, -1.0); },
     torque, Task::loosen},
    {Situation::other_way_off, "hint.other_way_off", HintMotion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, 20.0); }, torque, Task::loosen},
    {Situation::other_way_off, "hint.other_way_off", HintMotion::pull_off,
     [](Bench& b) { b.tick(1, Grip::wrench, 3.0, 0.5); }, torque, Task::loosen},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) { b.tick(1, Grip::fingers, -0.5); }, torque, Task::loosen},
    {Situation::set_back, "hint.set_back", HintMotion::set_back,
     [](Bench& b) {
         b.tick(1, Grip::wrench, -40.0);
         b.free_swing = 0.0;
     },
     torque, Task::loosen},
    {Situation::free, "hint.free", HintMotion::lift,
     [](Bench& b) {
         b.turn(1, -20.0, -1.0);
         b.state.joints[1].stage = joint::Stage::navigation;
         b.tick(1, Grip::wrench, -0.1, -1.0);
     },
     torque, Task::loosen},
    {Situation::turn_on, "hint.turn_on", HintMotion::pull_on,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 20.0);
     }},
    {Situation::ease_to_angle, "hint.ease_to_angle", HintMotion::pull_on,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 40.0);
         b.tick(0, Grip::wrench, 50.0, to_radians(2.0) / 1e-3);
     }},
    {Situation::stop_at_angle, "hint.stop_at_angle", HintMotion::lift,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 60.0);
     }},
    {Situation::stop_too_far, "hint.stop_too_far", HintMotion::lift,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 80.0);
     }},
    {Situation::take_off, "hint.take_off", HintMotion::lift,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 60.0);
         b.tick(0, Grip::wrench, 5.0);
     }},
    {Situation::set_back, "hint.set_back", HintMotion::set_back,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, 20.0);
         b.free_swing = 0.02;
     }},
    {Situation::other_way_on, "hint.other_way_on", HintMotion::pull_on,
     [](Bench& b) {
         b.by_angle();
         b.turn_by(0, -10.0, -30.0);
     }},
    {Situation::wrench_needed, "hint.wrench_needed", HintMotion::let_go,
     [](Bench& b) {
         b.by_angle();
         b.tick(0, Grip::fingers, 0.5);
     }},
    {Situation::turn_back, "hint.turn_back", HintMotion::pull_off,
     [](Bench& b) {
         b.turned_back();
         b.turn_by(1, -20.0, -20.0);
     },
     torque, Task::loosen},
    {Situation::turned_back, "hint.turned_back", HintMotion::lift,
     [](Bench& b) {
         b.turned_back();
         b.turn_by(1, -50.0, -20.0);
     },
     torque, Task::loosen},
    {Situation::all_done, "hint.all_done", HintMotion::none,
     [](Bench& b) {
         b.to_the_check();
         for (const int joint : {0, 1}) b.pull(joint, 70.0);
     }},
};

// Announcements of a step, which depend on time.
constexpr Situation announced[] = {Situation::next,       Situation::pass_run_down,  Situation::pass_tighten,
                                   Situation::pass_turn,  Situation::pass_turn_back, Situation::pass_recheck,
                                   Situation::pass_loosen};

words::Words words_in(std::string_view language) {
    words::LoadedWords loaded = words::load_words(words::words_folder(), language);
    REQUIRE(loaded.ok());
    return std::move(loaded.words);
}

}  // namespace

TEST_CASE("Hints: every situation is recognised") {
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

TEST_CASE("Hints: guided: every situation has a complete hint for the due joint in every language") {
    std::vector<words::Words> languages;
    for (const char* language : {"en", "de", "zh"}) languages.push_back(words_in(language));
    for (const Case& c : cases) {
        CAPTURE(c.text);
        Bench b(Mode::guided, c.strategy, c.task);
        c.arrange(b);
        b.wait(3.5);  // until the announcement has ended
        REQUIRE(b.hints.shown);
        const Hint hint = *b.hints.shown;
        CHECK(static_cast<int>(hint.situation) == static_cast<int>(c.situation));
        CHECK(hint.text.row().name == c.text);
        CHECK(static_cast<int>(hint.motion) == static_cast<int>(c.motion));
        const LessonStep* due = b.lesson.due();
        CHECK(hint.joint == (due == nullptr ? -1 : static_cast<int>(due->joint)));
        for (int level = 0; level <= 3; ++level) {
            Hint at = hint;
            at.level = level;
            for (const words::Words& language : languages) {
                const std::string text = hint_text(language, at);
                CHECK_FALSE(text.empty());
                CHECK(text.find('{') == std::string::npos);
                for (const ControlNames& controls :
                     {mouse_controls(language, "T"), device_controls(language, "A", "T"),
                      puck_controls(language, "A", "T"), keyboard_controls(language, "Space", "T"),
                      glove_controls(language, puck_controls(language, "A", "T"))}) {
                    const std::string motion = motion_text(language, at, controls);
                    CHECK(motion.empty() == (level < 3 || c.motion == HintMotion::none));
                    CHECK(motion.find('{') == std::string::npos);
                    const std::string pressed = words::replace_placeholders(
                        language, controls[static_cast<std::size_t>(c.motion)], hint.arguments);
                    CHECK(pressed.empty() == (c.motion == HintMotion::none));
                    CHECK((motion.empty() || motion.find(pressed) != std::string::npos));
                }
            }
        }
    }
}

TEST_CASE("Hints: assessment: no hint in any situation, requested or not") {
    for (const Case& c : cases) {
        Bench b(Mode::assessment, c.strategy, c.task);
        c.arrange(b);
        for (int i = 0; i < 1000; ++i) CHECK_FALSE(b.frame(0.1, i % 7 == 0).has_value());
    }
}

TEST_CASE("Hints: practice: no hint until a long time has passed or the trainee requests one") {
    for (const Case& c : cases) {
        CAPTURE(c.text);
        Bench b(Mode::practice, c.strategy, c.task);
        c.arrange(b);
        CHECK_FALSE(b.wait(19.0).has_value());
        CHECK(b.wait(2.0).has_value());
        Bench requested(Mode::practice, c.strategy, c.task);
        c.arrange(requested);
        requested.wait(3.5);
        CHECK_FALSE(requested.frame().has_value());
        REQUIRE(requested.frame(0.05, true).has_value());
        CHECK(static_cast<int>(requested.hints.shown->situation) == static_cast<int>(c.situation));
    }
}

TEST_CASE("Hints: texts have the numbers of the step") {
    const words::Words en = words_in("en");
    Bench b;
    b.seat_both();
    b.turn(0, 10.0);
    b.wait(2.0);
    CHECK(hint_text(en, *b.hints.shown) == "Pull clockwise, smoothly, until A has 35 N·m.");
    b.turn(0, 45.0);
    b.frame();
    CHECK(hint_text(en, *b.hints.shown) == "Stop. A should get 38.5 N·m at most.");
    Bench wrong;
    wrong.seat_both();
    wrong.tick(1, Grip::wrench, 0.2);
    wrong.wait(2.0);
    CHECK(hint_text(en, *wrong.hints.shown) == "This is B. A is due: let go and go there.");
    Bench start;
    start.seat_both();
    start.frame();
    CHECK(hint_text(en, *start.hints.shown) ==
          "This round: tighten all nuts to 50 % of their torque. Begin with A.");
    start.wait(4.0);
    CHECK(hint_text(en, *start.hints.shown) == "Take the 24 mm wrench.");
    start.wait(12.0);
    CHECK(motion_text(en, *start.hints.shown, mouse_controls(en, "T")) ==
          "Move the hand to the wrench and close it on the handle: press T or click on the wrench.");
}

TEST_CASE("Hints: name the nut, or the screw that is turned at its head, of the due joint") {
    const words::Words en = words_in("en"), de = words_in("de"), zh = words_in("zh");
    const auto start = [](std::initializer_list<std::size_t> screws) {
        Bench b;
        for (const std::size_t joint : screws)
            b.assembly.joints[joint].design.turned = joint::TurnedPart::head;
        b.frame();
        return *b.hints.shown;
    };
    CHECK(hint_text(en, start({})) ==
          "This round: run all nuts down by hand until they are seated. Begin with A.");
    CHECK(hint_text(en, start({0, 1})) ==
          "This round: run all screws down by hand until they are seated. Begin with A.");
    CHECK(hint_text(en, start({1})) ==
          "This round: run all nuts and screws down by hand until they are seated. Begin with A.");
    CHECK(hint_text(de, start({0, 1})) ==
          "Dieser Umlauf: alle Schrauben von Hand bis zur Anlage drehen. Beginnen Sie mit A.");
    CHECK(hint_text(zh, start({0, 1})) == "本轮：用手把所有螺钉拧到贴合。从 A 开始。");
    // Each joint by itself, in the motion too, and no screw's hint names a nut in any situation and language.
    Bench b;
    b.assembly.joints[1].design.turned = joint::TurnedPart::head;
    Hint nut = make_hint(Situation::grip_nut, Situation::grip_nut, 3, b.work_state());
    CHECK(hint_text(en, nut) == "Take the nut of A between your fingers.");
    CHECK(motion_text(en, nut, mouse_controls(en, "T")).find("two faces of the nut") != std::string::npos);
    for (content::AssemblyJoint& joint : b.assembly.joints) joint.design.turned = joint::TurnedPart::head;
    for (std::size_t i = 0; i < situation_count; ++i) {
        const auto situation = static_cast<Situation>(i);
        const Hint hint = make_hint(situation, situation, 3, b.work_state());
        for (const words::Words* words : {&en, &de, &zh}) {
            const std::string text = hint_text(*words, hint) +
                                     motion_text(*words, hint, mouse_controls(*words, "T")) +
                                     motion_text(*words, hint, tracked_controls(*words));
            CAPTURE(text);
            for (const char* word : {" nut", "Nut", "Mutter", "螺母", "螺栓", "bolt"})
                CHECK(text.find(word) == std::string::npos);
        }
    }
}

TEST_CASE("Hints: with a glove, controls name the device that moves the hand and the fingers that grip") {
    const auto loaded = words::load_words(words::words_folder(), "en");
    REQUIRE(loaded.ok());
    const ControlNames keys = keyboard_controls(loaded.words, "Space", "T"),
                       gloved = glove_controls(loaded.words, keys);
    const auto of = [](const ControlNames& controls, HintMotion motion) {
        return controls[static_cast<std::size_t>(motion)];
    };
    CHECK(of(gloved, HintMotion::set_on) == of(keys, HintMotion::set_on));
    CHECK(of(gloved, HintMotion::pull_on) == of(keys, HintMotion::pull_on));
    CHECK(of(gloved, HintMotion::take).find("close your hand") != std::string::npos);
    CHECK(of(gloved, HintMotion::grip_nut).find("pinch") != std::string::npos);
}

}  // namespace hints_situations_test
